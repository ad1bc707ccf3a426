#include "linear/cholesky/elimination_order.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <numeric>
#include <utility>

#include "common/all_ranks.hpp"
#include "common/petsc_attached.hpp"
#include "linear/cholesky/block_graph.hpp"
#include "linear/cholesky/shared_dissection.hpp"
#include "linear/kernels/adjacency.hpp"
#include "linear/kernels/gather.hpp"

namespace chladni::linear {

namespace {

/// Blocks with ten times as many neighbours as the mean (harmonics of a ring) come last, in tenths.
constexpr idx_t dense_degree = 100;

bool is_permutation_of_all(std::vector<idx_t> places)
{
  std::ranges::sort(places);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (std::cmp_not_equal(places[i], i)) return false;
  return true;
}

[[noreturn]] void refuse(std::ptrdiff_t n_blocks, std::ptrdiff_t n_edges)
{
  throw Error(
      fmt::format("elimination_order: METIS finds no order of {} blocks with {} edges; take "
                  "-cms_pc_factor_mat_solver_type mumps, which orders by itself",
                  n_blocks, n_edges));
}

/// Place of each block in the elimination.
std::vector<idx_t> dissect(const Adjacency& graph, std::vector<idx_t> weights)
{
  assert(is_symmetric(graph));  // or METIS loops for ever
  auto n = static_cast<idx_t>(graph.n_vertices());
  std::vector<idx_t> starts(graph.starts.begin(), graph.starts.end());
  std::vector<idx_t> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::vector<idx_t> order(weights.size()), place(weights.size());
  if (neighbours.empty()) {  // METIS rejects a graph without edges
    std::iota(place.begin(), place.end(), idx_t{0});
    return place;
  }
  std::array<idx_t, METIS_NOPTIONS> options{};
  METIS_SetDefaultOptions(options.data());
  options[METIS_OPTION_PFACTOR] = dense_degree;
  const int status = METIS_NodeND(&n, starts.data(), neighbours.data(), weights.data(),
                                  options.data(), order.data(), place.data());
  if (status != METIS_OK || !is_permutation_of_all(place))
    refuse(std::ssize(place), std::ssize(neighbours));
  return place;
}

/// A graph and its order.
struct Dissected {
  Adjacency graph;
  std::vector<idx_t> weights, place;
};

/// `dissect`, which is asked for a few graphs again and again where the harmonics of one sector are
/// factored, or one matrix with another shift: the last ones are remembered.
std::vector<idx_t> dissect_once(const Adjacency& graph, const std::vector<idx_t>& weights)
{
  constexpr std::size_t most = 6, most_neighbours = 1U << 21;  // 50 MB at most
  thread_local std::deque<Dissected> last;
  const auto known = std::ranges::find_if(last, [&](const Dissected& other) {
    return other.weights == weights && other.graph.starts == graph.starts &&
           other.graph.neighbours == graph.neighbours;
  });
  if (known != last.end()) return known->place;
  std::vector<idx_t> place = dissect(graph, weights);
  if (graph.neighbours.size() > most_neighbours) return place;
  last.push_front({.graph = graph, .weights = weights, .place = place});
  if (last.size() > most) last.pop_back();
  return place;
}

/// True for graphs that are worth the messages, and whose separators no block with many neighbours
/// spoils.
bool is_dissected_together(const std::vector<int>& degrees, MPI_Comm comm)
{
  constexpr std::size_t large = 10000;
  if (petsc::size(comm) == 1 || degrees.size() < large) return false;
  const double all = std::accumulate(degrees.begin(), degrees.end(), 0.0);
  const double dense = dense_degree / 10.0 * all / double(degrees.size());
  return std::ranges::max(degrees) <= dense;
}

/// From places of blocks to places of rows, from 1.
template <typename Number>
std::vector<int> row_places(const std::vector<Number>& place, const std::vector<int>& block_of,
                            const std::vector<Number>& sizes)
{
  std::vector<int> size_at(place.size() + 1, 0), next(place.size());
  for (std::size_t b = 0; b < place.size(); ++b) size_at[place[b] + 1] = sizes[b];
  std::inclusive_scan(size_at.begin(), size_at.end(), size_at.begin());
  for (std::size_t b = 0; b < place.size(); ++b) next[b] = size_at[place[b]] + 1;
  std::vector<int> places;
  places.reserve(block_of.size());
  for (const int block : block_of)
    if (block != left_out) places.push_back(next[block]++);
  return places;
}

template <typename Number>
std::vector<Number> block_sizes(const std::vector<int>& block_of, std::size_t n_blocks)
{
  std::vector<Number> sizes(n_blocks, 0);
  for (const int block : block_of)
    if (block != left_out) ++sizes[block];
  return sizes;
}

constexpr const char* order_of_matrix = "chladni_order";

}  // namespace

void keep_order(Mat A, std::vector<int> places)
{
  petsc::keep_with(reinterpret_cast<PetscObject>(A), order_of_matrix,
                   std::make_unique<std::vector<int>>(std::move(places)));
}

std::vector<int> elimination_order(Mat A)
{
  const auto* known =
      petsc::kept_with<std::vector<int>>(reinterpret_cast<PetscObject>(A), order_of_matrix);
  return known != nullptr ? *known : elimination_order(A, nullptr);
}

std::vector<int> elimination_order(Mat A, IS rows)
{
  const MPI_Comm comm = petsc::communicator(A);
  const OwnBlocks blocks = own_blocks(A, rows);
  std::vector<int> block_of = block_of_rows(A, blocks);
  BlockGraph own = own_graph(A, blocks, block_of);
  if (is_dissected_together(gather_on_all(own.degrees, MPI_INT, comm), comm)) {
    merge_alike(own, block_of, comm);
    const Adjacency graph =
        joined({.starts = offsets(own.degrees), .neighbours = std::move(own.neighbours)}, comm);
    const std::vector<int> sizes = block_sizes<int>(block_of, graph.n_vertices());
    const std::vector<int> place = shared_dissection(graph, sizes, comm);
    return on_all_ranks(comm, [&]() -> std::vector<int> {
      if (petsc::rank(comm) != 0) return {};
      if (place.empty()) refuse(graph.n_vertices(), std::ssize(graph.neighbours));
      return row_places(place, block_of, sizes);
    });
  }
  const std::vector<int> degrees = gather(std::move(own.degrees), MPI_INT, comm);
  std::vector<int> neighbours = gather(std::move(own.neighbours), MPI_INT, comm);
  return on_all_ranks(comm, [&]() -> std::vector<int> {
    if (petsc::rank(comm) != 0) return {};
    const Adjacency graph =
        symmetrized({.starts = offsets(degrees), .neighbours = std::move(neighbours)});
    const std::vector<idx_t> sizes = block_sizes<idx_t>(block_of, degrees.size());
    return row_places(dissect_once(graph, sizes), block_of, sizes);
  });
}

}  // namespace chladni::linear
