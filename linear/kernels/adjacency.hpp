#pragma once

#include <mpi.h>

#include <vector>

namespace chladni::linear {

/// A graph in compressed form: the neighbours of each vertex, without the vertex itself.
struct Adjacency {
  std::vector<int> starts = {0};  ///< [n_vertices + 1]
  std::vector<int> neighbours;

  int n_vertices() const { return static_cast<int>(starts.size()) - 1; }
};

/// The graph with an edge in both directions wherever there is one in either. The pattern of a
/// symmetric matrix is not symmetric if a zero is stored at (i, j) and not at (j, i), but METIS and
/// the elimination tree require symmetry. Existing neighbours keep their order.
/// @throws chladni::Error when there are more edges than METIS can count.
Adjacency symmetrized(Adjacency graph);

/// The same of a graph whose vertices the ranks have, one rank after the other, on all ranks.
/// @param part  the vertices of this rank; their neighbours are numbered over all ranks
/// @note   Collective.
Adjacency joined(Adjacency part, MPI_Comm comm);

/// True if each edge exists in both directions.
bool is_symmetric(const Adjacency& graph);

}  // namespace chladni::linear
