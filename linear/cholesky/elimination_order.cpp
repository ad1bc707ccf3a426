#include "linear/cholesky/elimination_order.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <numeric>
#include <utility>

#include "common/all_ranks.hpp"
#include "common/index_sets.hpp"
#include "common/petsc_attached.hpp"
#include "linear/cholesky/shared_dissection.hpp"
#include "linear/kernels/adjacency.hpp"
#include "linear/kernels/fingerprint.hpp"
#include "linear/kernels/gather.hpp"

namespace chladni::linear {

namespace {

/// The columns of one local row.
std::vector<PetscInt> pattern(Mat A, PetscInt row)
{
  PetscInt n = 0;
  const PetscInt* columns = nullptr;
  petsc::check(MatGetRow(A, row, &n, &columns, nullptr));
  std::vector<PetscInt> copy(columns, columns + n);
  petsc::check(MatRestoreRow(A, row, &n, &columns, nullptr));
  return copy;
}

/// The rows of this rank that are ordered, ascending, and the number of the block of each, counted
/// on this rank.
struct OwnBlocks {
  std::vector<PetscInt> rows;
  std::vector<int> block;
  int n_blocks() const { return block.empty() ? 0 : block.back() + 1; }
};

/// @param rows  null: all
OwnBlocks own_blocks(Mat A, IS rows)
{
  PetscInt first = 0, last = 0, block_size = 1;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  petsc::check(MatGetBlockSize(A, &block_size));
  OwnBlocks own;
  if (rows == nullptr) {
    own.rows.resize(std::size_t(last - first));
    std::iota(own.rows.begin(), own.rows.end(), first);
  } else {
    own.rows = petsc::own_indices(rows);
  }
  std::vector<PetscInt> before, now;
  for (const PetscInt row : own.rows) {
    now = block_size > 1 ? std::vector{row / block_size} : pattern(A, row);
    const bool is_alike = !own.block.empty() && now == before;
    own.block.push_back(is_alike ? own.block.back() : own.n_blocks());
    before.swap(now);
  }
  return own;
}

/// The first of the numbers of this rank, where the ranks count one after the other.
int first_number(int n_own, MPI_Comm comm)
{
  int first = 0;
  MPI_Exscan(&n_own, &first, 1, MPI_INT, MPI_SUM, comm);
  return petsc::rank(comm) == 0 ? 0 : first;
}

constexpr int left_out = -1;

/// Number of the block of each row of A, or `left_out`, on all ranks.
std::vector<int> block_of_rows(Mat A, const OwnBlocks& own)
{
  const MPI_Comm comm = petsc::communicator(A);
  PetscInt begin = 0, end = 0, n = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  petsc::check(MatGetSize(A, &n, nullptr));
  const int first = first_number(own.n_blocks(), comm);
  std::vector<int> here(std::size_t(end - begin), left_out);
  for (std::size_t i = 0; i < own.rows.size(); ++i)
    here[own.rows[i] - begin] = first + own.block[i];
  std::vector<int> all = gather(std::move(here), MPI_INT, comm);
  all.resize(n);
  MPI_Bcast(all.data(), n, MPI_INT, 0, comm);
  return all;
}

/// Adjacency of the blocks of this rank without themselves: length of each list, then the lists.
struct BlockGraph {
  std::vector<int> degrees;
  std::vector<int> neighbours;
};

BlockGraph own_graph(Mat A, const OwnBlocks& own, const std::vector<int>& block_of)
{
  BlockGraph graph{.degrees = std::vector(std::size_t(own.n_blocks()), 0), .neighbours = {}};
  const int last = block_of.empty() ? left_out : std::ranges::max(block_of);
  std::vector<int> seen_by(std::size_t(last + 1), left_out);
  for (std::size_t i = 0; i < own.rows.size(); ++i) {
    const int self = block_of[own.rows[i]];
    seen_by[self] = self;
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    petsc::check(MatGetRow(A, own.rows[i], &n, &columns, nullptr));
    for (PetscInt k = 0; k < n; ++k) {
      const int other = block_of[columns[k]];
      if (other == left_out || seen_by[other] == self) continue;
      seen_by[other] = self;
      graph.neighbours.push_back(other);
      ++graph.degrees[own.block[i]];
    }
    petsc::check(MatRestoreRow(A, own.rows[i], &n, &columns, nullptr));
  }
  return graph;
}

/// Blocks of this rank with the same neighbours, each counted among its own, become one: they are
/// eliminated together in any case. Of cubic quadrilaterals four of nine are left.
/// METIS_NodeND does that by itself, but the graph that ranks send each other is a fifth then.
/// @param graph     of the blocks of this rank; afterwards of those that are left
/// @param block_of  [rows of A] numbers of the blocks, which become those of the ones left
void merge_alike(BlockGraph& graph, std::vector<int>& block_of, MPI_Comm comm)
{
  const auto n_own = static_cast<int>(graph.degrees.size());
  const int first = first_number(n_own, comm);
  ByFingerprint<int> known;
  std::vector<int> merged;  // the new number of each
  auto next = graph.neighbours.cbegin();
  for (int b = 0; b < n_own; ++b) {
    Fingerprint neighbours;
    neighbours.add(std::uint64_t(first) + std::uint64_t(b));
    for (int k = 0; k < graph.degrees[b]; ++k) neighbours.add(std::uint64_t(*next++));
    merged.push_back(known.try_emplace(neighbours, std::ssize(known)).first->second);
  }
  const int first_merged = first_number(static_cast<int>(known.size()), comm);
  for (int& number : merged) number += first_merged;
  const std::vector<int> new_number = gather_on_all(merged, MPI_INT, comm);
  for (int& block : block_of)
    if (block != left_out) block = new_number[block];

  BlockGraph left;
  std::vector<int> seen_by(new_number.size(), left_out);
  next = graph.neighbours.cbegin();
  for (int b = 0; b < n_own; ++b) {
    const auto last = next + graph.degrees[b];
    const int self = merged[b];
    const bool is_first = std::cmp_equal(self - first_merged, left.degrees.size());
    if (is_first) {
      const std::size_t before = left.neighbours.size();
      seen_by[self] = self;
      for (; next != last; ++next) {
        const int other = new_number[*next];
        if (std::exchange(seen_by[other], self) != self) left.neighbours.push_back(other);
      }
      left.degrees.push_back(static_cast<int>(left.neighbours.size() - before));
    }
    next = last;
  }
  graph = std::move(left);
}

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
