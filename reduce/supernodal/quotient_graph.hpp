#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::reduce {

/// The graph of a symmetric sparse matrix after rows of equal pattern on one rank became one
/// vertex: the six DOFs of a node of a shell, or its three of bending and its three in the plane
/// where these do not interact.
struct QuotientGraph {
  std::vector<int> vertex_of_row;  ///< [n]
  std::vector<int> n_rows;         ///< [n_vertices]
  std::vector<int> starts;         ///< [n_vertices + 1]
  std::vector<int> neighbours;     ///< of each vertex, without itself

  int n_vertices() const { return static_cast<int>(n_rows.size()); }
};

/// @param A  [n x n] AIJ, pattern symmetric with the diagonal.
/// @return the same on all ranks.
/// @note   Collective on the communicator of A.
QuotientGraph quotient_graph(Mat A);

}  // namespace chladni::reduce
