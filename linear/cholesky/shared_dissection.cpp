#include "linear/cholesky/shared_dissection.hpp"

#include <metis.h>

#include <array>
#include <utility>

#include "common/petsc.hpp"

namespace chladni::linear {

namespace {

constexpr int no_part = -1;
/// How much larger than half a part may be, in thousandths. METIS allows 200, with separators of a
/// twentieth less work, but ranks then wait for the one with the largest part.
constexpr idx_t uneven = 30;

/// Separators of which METIS takes the best; as many as it tries where it merges vertices itself.
constexpr idx_t separators_tried = 2;

/// Some vertices of a graph, and the first of their places.
struct Part {
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
  void dissect(Part part, MPI_Comm comm)
  {
    if (petsc::size(comm) == 1) return dissect_alone(part);
    const std::vector<idx_t> side = separated(part, comm);
    std::array<Part, 3> parts;  // two, and their separator
    for (std::size_t i = 0; i < side.size(); ++i)
      parts[std::size_t(side[i])].vertices.push_back(part.vertices[i]);
    for (Part& some : parts) {
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
  PartGraph graph_of(const Part& part)
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

  void number(const Part& part)
  {
    int place = part.first_place;
    for (const int v : part.vertices) places_[std::size_t(v)] = place++;
  }

  /// 0 or 1 for each vertex, by its side, and 2 in the separator.
  std::vector<idx_t> separated(const Part& part, MPI_Comm comm)
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

  void dissect_alone(const Part& part)
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
  Part all;
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

}  // namespace chladni::linear
