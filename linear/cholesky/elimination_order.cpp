#include "linear/cholesky/elimination_order.hpp"

#include <metis.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <numeric>
#include <utility>

#include "common/all_ranks.hpp"
#include "common/petsc.hpp"
#include "linear/cholesky/block_graph.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/matrix_graph.hpp"

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

[[noreturn]] void refuse_size(std::ptrdiff_t n_blocks, std::ptrdiff_t n_edges)
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
    refuse_size(std::ssize(place), std::ssize(neighbours));
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
      if (place.empty()) refuse_size(graph.n_vertices(), std::ssize(graph.neighbours));
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

namespace {

constexpr int no_part = -1;
/// How much larger than half a part may be, in thousandths. METIS allows 200, with separators of a
/// twentieth less work, but ranks then wait for the one with the largest part.
constexpr idx_t uneven = 30;

/// Separators of which METIS takes the best; as many as it tries where it merges vertices itself.
constexpr idx_t separators_tried = 2;

/// Some vertices of a graph, and the first of their places.
struct DissectedPart {
  std::vector<int> vertices;
  int first_place = 0;
};

/// The graph of a part as METIS takes it.
struct PartGraph {
  std::vector<idx_t> starts = {0}, neighbours, weights;

  idx_t n_vertices() const { return static_cast<idx_t>(weights.size()); }
};

bool has_each_place_once(const std::vector<int>& places)
{
  std::vector<char> is_taken(places.size(), 0);
  for (const int place : places) {
    if (place < 0 || place >= std::ssize(places) || is_taken[std::size_t(place)] != 0) return false;
    is_taken[std::size_t(place)] = 1;
  }
  return true;
}

class SharedDissection {
 public:
  SharedDissection(const Adjacency& graph, const std::vector<int>& weights)
      : graph_(graph),
        weights_(weights),
        number_(weights.size(), no_part),
        places_(weights.size(), 0)
  {}

  /// Numbers the vertices of a part, which all ranks of the communicator have.
  void dissect(DissectedPart part, MPI_Comm comm)
  {
    if (petsc::size(comm) == 1) return dissect_alone(part);
    const std::vector<idx_t> side = separated(part, comm);
    std::array<DissectedPart, 3> parts;  // two, and their separator
    for (std::size_t i = 0; i < side.size(); ++i)
      parts[std::size_t(side[i])].vertices.push_back(part.vertices[i]);
    for (DissectedPart& some : parts) {
      some.first_place = part.first_place;
      part.first_place += static_cast<int>(some.vertices.size());
    }
    if (petsc::rank(comm) == 0) number(parts[2]);
    const bool is_first = petsc::rank(comm) < (petsc::size(comm) + 1) / 2;
    MPI_Comm half = MPI_COMM_NULL;
    MPI_Comm_split(comm, is_first ? 0 : 1, 0, &half);
    dissect(std::move(parts[is_first ? 0 : 1]), half);
    MPI_Comm_free(&half);
  }

  /// Those that this rank has numbered; 0 for the others.
  std::vector<int>& places() { return places_; }
  bool has_failed() const { return has_failed_; }

 private:
  PartGraph graph_of(const DissectedPart& part)
  {
    PartGraph graph;
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      number_[std::size_t(part.vertices[i])] = static_cast<int>(i);
    for (const int v : part.vertices) {
      graph.weights.push_back(weights_[std::size_t(v)]);
      for (int k = graph_.starts[v]; k < graph_.starts[v + 1]; ++k)
        if (const int w = number_[graph_.neighbours[k]]; w != no_part)
          graph.neighbours.push_back(w);
      graph.starts.push_back(static_cast<idx_t>(graph.neighbours.size()));
    }
    for (const int v : part.vertices) number_[std::size_t(v)] = no_part;
    return graph;
  }

  void number(const DissectedPart& part)
  {
    int place = part.first_place;
    for (const int v : part.vertices) places_[std::size_t(v)] = place++;
  }

  /// 0 or 1 for each vertex, by its side, and 2 in the separator.
  std::vector<idx_t> separated(const DissectedPart& part, MPI_Comm comm)
  {
    std::vector<idx_t> side(part.vertices.size(), 0);
    if (petsc::rank(comm) == 0) {
      PartGraph graph = graph_of(part);
      idx_t n = graph.n_vertices(), weight_of_separator = 0;
      if (!graph.neighbours.empty()) {
        std::array<idx_t, METIS_NOPTIONS> options{};
        METIS_SetDefaultOptions(options.data());
        options[METIS_OPTION_UFACTOR] = uneven;
        options[METIS_OPTION_NSEPS] = separators_tried;
        const int status = METIS_ComputeVertexSeparator(
            &n, graph.starts.data(), graph.neighbours.data(), graph.weights.data(), options.data(),
            &weight_of_separator, side.data());
        has_failed_ = has_failed_ || status != METIS_OK;
      }
    }
    const int n_bytes = static_cast<int>(side.size() * sizeof(idx_t));
    MPI_Bcast(side.data(), n_bytes, MPI_BYTE, 0, comm);
    return side;
  }

  void dissect_alone(const DissectedPart& part)
  {
    PartGraph graph = graph_of(part);
    if (graph.neighbours.empty()) return number(part);  // METIS rejects it
    idx_t n = graph.n_vertices();
    std::vector<idx_t> order(graph.weights.size()), place(graph.weights.size());
    std::array<idx_t, METIS_NOPTIONS> options{};
    METIS_SetDefaultOptions(options.data());
    options[METIS_OPTION_NSEPS] = separators_tried;
    const int status =
        METIS_NodeND(&n, graph.starts.data(), graph.neighbours.data(), graph.weights.data(),
                     options.data(), order.data(), place.data());
    has_failed_ = has_failed_ || status != METIS_OK;
    for (std::size_t i = 0; i < place.size(); ++i)
      places_[std::size_t(part.vertices[i])] = part.first_place + static_cast<int>(place[i]);
  }

  const Adjacency& graph_;
  const std::vector<int>& weights_;
  std::vector<int> number_;  ///< of each vertex in a part
  std::vector<int> places_;
  bool has_failed_ = false;
};

}  // namespace

std::vector<int> shared_dissection(const Adjacency& graph, const std::vector<int>& weights,
                                   MPI_Comm comm)
{
  SharedDissection dissection(graph, weights);
  DissectedPart all;
  for (int v = 0; v < graph.n_vertices(); ++v) all.vertices.push_back(v);
  MPI_Comm own = MPI_COMM_NULL;
  MPI_Comm_dup(comm, &own);
  dissection.dissect(std::move(all), own);
  MPI_Comm_free(&own);
  int failed = dissection.has_failed() ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, comm);
  if (failed == 1) return {};
  std::vector<int>& places = dissection.places();
  std::vector<int> sum(petsc::rank(comm) == 0 ? places.size() : 0);
  MPI_Reduce(places.data(), sum.data(), static_cast<int>(places.size()), MPI_INT, MPI_SUM, 0, comm);
  return has_each_place_once(sum) ? sum : std::vector<int>();
}

std::vector<int> extended_order(Mat A, const std::vector<int>& known)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  const auto end = static_cast<int>(known.size());
  std::vector<int> behind;  // the known place at or behind which each own row comes
  for (PetscInt row = first; row < last; ++row) {
    int place = known[row];
    if (place == -1) {
      PetscInt n = 0;
      const PetscInt* columns = nullptr;
      petsc::check(MatGetRow(A, row, &n, &columns, nullptr));
      for (PetscInt k = 0; k < n; ++k) place = std::max(place, known[columns[k]]);
      petsc::check(MatRestoreRow(A, row, &n, &columns, nullptr));
    }
    behind.push_back(place == -1 ? end : place);
  }
  behind = gather_on_all(behind, MPI_INT, petsc::communicator(A));
  std::vector<int> order(behind.size()), places(behind.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int row) { return std::pair(behind[row], known[row] == -1 ? row + 1 : 0); };
  std::ranges::sort(order, {}, key);
  for (std::size_t i = 0; i < order.size(); ++i) places[order[i]] = static_cast<int>(i);
  return places;
}

}  // namespace chladni::linear
