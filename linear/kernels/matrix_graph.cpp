#include "linear/kernels/matrix_graph.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "common/checked_count.hpp"
#include "common/petsc.hpp"
#include "linear/kernels/gather.hpp"

namespace chladni::linear {

namespace {

/// The edges in the other direction; the neighbours ascend.
Adjacency transposed(const Adjacency& graph)
{
  const int n = graph.n_vertices();
  Adjacency result{.starts = std::vector<int>(n + 1, 0),
                   .neighbours = std::vector<int>(graph.neighbours.size())};
  for (const int v : graph.neighbours) ++result.starts[v + 1];
  std::inclusive_scan(result.starts.begin(), result.starts.end(), result.starts.begin());
  std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
  for (int v = 0; v < n; ++v)
    for (int k = graph.starts[v]; k < graph.starts[v + 1]; ++k)
      result.neighbours[next[graph.neighbours[k]]++] = v;
  return result;
}

/// Calls visit(v, w) for each edge w -> v that has no partner v -> w, v ascending.
template <typename Visit>
void for_missing(const Adjacency& graph, const Visit& visit)
{
  const Adjacency back = transposed(graph);
  std::vector<int> seen_by(graph.n_vertices(), -1);
  for (int v = 0; v < graph.n_vertices(); ++v) {
    for (int k = graph.starts[v]; k < graph.starts[v + 1]; ++k) seen_by[graph.neighbours[k]] = v;
    for (int k = back.starts[v]; k < back.starts[v + 1]; ++k)
      if (seen_by[back.neighbours[k]] != v) visit(v, back.neighbours[k]);
  }
}

/// Vertices of this rank among those of all.
struct Numbering {
  MPI_Comm comm;  ///< null where this rank has all
  int first, n_all;
};

Numbering numbering(int n_own, MPI_Comm comm)
{
  Numbering numbers{.comm = comm, .first = first_number(n_own, comm), .n_all = 0};
  MPI_Allreduce(&n_own, &numbers.n_all, 1, MPI_INT, MPI_SUM, comm);
  return numbers;
}

using DirectedEdge = std::pair<int, int>;

/// Calls visit(v, w) for the edges v -> w of vertices of this rank.
template <typename Visit>
void for_edges(const Adjacency& part, const Numbering& numbers, const Visit& visit)
{
  for (int v = 0; v < part.n_vertices(); ++v)
    for (int k = part.starts[v]; k < part.starts[v + 1]; ++k)
      visit(numbers.first + v, part.neighbours[k]);
}

void add_up(std::span<std::uint64_t> sums, MPI_Comm comm)
{
  if (comm == MPI_COMM_NULL) return;
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_UINT64_T, MPI_SUM,
                comm);
}

std::uint64_t number_of(int v, int w)
{
  const auto [low, high] = std::minmax(v, w);
  return mixed((std::uint64_t(low) << 32) + std::uint64_t(high));
}

/// Whether some edge has no partner, but for a probability of 2^-64: of a number for each edge, the
/// sum for edges to vertices that follow, less that for edges to those before. It reads the graph
/// once, where a transposed graph is written and read in another order.
bool lacks_partners(const Adjacency& part, const Numbering& numbers)
{
  std::uint64_t sum = 0;
  for_edges(part, numbers, [&](int v, int w) {
    const std::uint64_t edge = number_of(v, w);
    sum += v < w ? edge : 0 - edge;
  });
  add_up(std::span(&sum, 1), numbers.comm);
  return sum != 0;
}

/// The edges w -> v that have no partner, as (v, w) with v of this rank, ascending. Edges whose
/// numbers add up at both of their ends have one.
std::vector<DirectedEdge> missing_edges(const Adjacency& part, const Numbering& numbers)
{
  std::vector<std::uint64_t> sums(std::size_t(numbers.n_all), 0);
  for_edges(part, numbers, [&](int v, int w) {
    const std::uint64_t edge = number_of(v, w);
    sums[std::size_t(v)] += edge;
    sums[std::size_t(w)] -= edge;
  });
  add_up(sums, numbers.comm);
  std::vector<int> own_ends;
  for_edges(part, numbers, [&](int v, int w) {
    if (sums[std::size_t(v)] == 0 || sums[std::size_t(w)] == 0) return;
    own_ends.push_back(v);
    own_ends.push_back(w);
  });
  const std::vector<int> ends = numbers.comm == MPI_COMM_NULL
                                    ? std::move(own_ends)
                                    : gather_on_all(std::move(own_ends), MPI_INT, numbers.comm);
  std::vector<DirectedEdge> edges, missing;
  for (std::size_t k = 0; k < ends.size(); k += 2) edges.emplace_back(ends[k], ends[k + 1]);
  std::ranges::sort(edges);
  for (const auto& [w, v] : edges) {
    const bool is_own = v >= numbers.first && v < numbers.first + part.n_vertices();
    if (is_own && !std::ranges::binary_search(edges, DirectedEdge(v, w)))
      missing.emplace_back(v, w);
  }
  std::ranges::sort(missing);
  return missing;
}

/// The graph and some more edges of its vertices, in their order.
Adjacency extended(const Adjacency& part, const Numbering& numbers,
                   const std::vector<DirectedEdge>& missing)
{
  Adjacency result;
  result.starts.reserve(part.starts.size());
  result.neighbours.reserve(checked_count(std::ssize(part.neighbours) + std::ssize(missing),
                                          "edges between the rows of a matrix",
                                          "use a coarser mesh"));
  auto next = missing.begin();
  for (int v = 0; v < part.n_vertices(); ++v) {
    const auto begin = part.neighbours.begin();
    result.neighbours.insert(result.neighbours.end(), begin + part.starts[v],
                             begin + part.starts[v + 1]);
    for (; next != missing.end() && next->first == numbers.first + v; ++next)
      result.neighbours.push_back(next->second);
    result.starts.push_back(static_cast<int>(result.neighbours.size()));
  }
  return result;
}

Adjacency with_partners(Adjacency part, const Numbering& numbers)
{
  if (!lacks_partners(part, numbers)) return part;
  return extended(part, numbers, missing_edges(part, numbers));
}

}  // namespace

Adjacency symmetrized(Adjacency graph)
{
  const Numbering numbers{.comm = MPI_COMM_NULL, .first = 0, .n_all = graph.n_vertices()};
  return with_partners(std::move(graph), numbers);
}

Adjacency joined(Adjacency part, MPI_Comm comm)
{
  if (petsc::size(comm) == 1) return symmetrized(std::move(part));
  const Numbering numbers = numbering(part.n_vertices(), comm);
  part = with_partners(std::move(part), numbers);
  std::vector<int> degrees(std::size_t(part.n_vertices()));
  for (int v = 0; v < part.n_vertices(); ++v) degrees[v] = part.starts[v + 1] - part.starts[v];
  Adjacency whole{.starts = offsets(gather_on_all(std::move(degrees), MPI_INT, comm)),
                  .neighbours = gather_on_all(std::move(part.neighbours), MPI_INT, comm)};
  assert(is_symmetric(whole));
  return whole;
}

bool is_symmetric(const Adjacency& graph)
{
  bool symmetric = true;
  for_missing(graph, [&](int, int) { symmetric = false; });
  return symmetric;
}

}  // namespace chladni::linear
