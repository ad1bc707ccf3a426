#pragma once

#include <vector>

namespace chladni::linear {

/// A graph in compressed form: the neighbours of each vertex, without itself.
struct Adjacency {
  std::vector<int> starts = {0};  ///< [n_vertices + 1]
  std::vector<int> neighbours;

  int n_vertices() const { return static_cast<int>(starts.size()) - 1; }
};

/// The graph with an edge in both directions wherever there is one in either. The pattern of a
/// symmetric matrix is not symmetric where a zero is stored at (i, j) and not at (j, i); METIS and
/// the elimination tree rely on both. Neighbours that are there keep their order.
/// @throws chladni::Error when there are more edges than METIS counts.
Adjacency symmetrized(const Adjacency& graph);

/// Whether each edge stands in both directions.
bool is_symmetric(const Adjacency& graph);

}  // namespace chladni::linear
