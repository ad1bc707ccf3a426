#include "linear/kernels/adjacency.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "common/checked_count.hpp"

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

}  // namespace

std::uint64_t lacking_partners(const Adjacency& part, int first)
{
  std::uint64_t sum = 0;
  for (int v = 0; v < part.n_vertices(); ++v) {
    for (int k = part.starts[v]; k < part.starts[v + 1]; ++k) {
      const int w = part.neighbours[k];
      const auto [low, high] = std::minmax(first + v, w);
      const std::uint64_t edge = mixed((std::uint64_t(low) << 32) + std::uint64_t(high));
      sum += first + v < w ? edge : 0 - edge;
    }
  }
  return sum;
}

Adjacency symmetrized(Adjacency graph)
{
  if (lacking_partners(graph, 0) == 0) return graph;
  std::vector<std::pair<int, int>> missing;
  for_missing(graph, [&](int v, int w) { missing.emplace_back(v, w); });
  if (missing.empty()) return graph;
  Adjacency result;
  result.starts.reserve(graph.starts.size());
  result.neighbours.reserve(checked_count(std::ssize(graph.neighbours) + std::ssize(missing),
                                          "edges between the rows of a matrix",
                                          "use a coarser mesh"));
  auto next = missing.begin();
  for (int v = 0; v < graph.n_vertices(); ++v) {
    const auto begin = graph.neighbours.begin();
    result.neighbours.insert(result.neighbours.end(), begin + graph.starts[v],
                             begin + graph.starts[v + 1]);
    for (; next != missing.end() && next->first == v; ++next)
      result.neighbours.push_back(next->second);
    result.starts.push_back(static_cast<int>(result.neighbours.size()));
  }
  assert(is_symmetric(result));
  return result;
}

bool is_symmetric(const Adjacency& graph)
{
  bool symmetric = true;
  for_missing(graph, [&](int, int) { symmetric = false; });
  return symmetric;
}

}  // namespace chladni::linear
