#pragma once

#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/matrix_graph.hpp"

namespace chladni::linear {

/// The graph of a symmetric sparse matrix in which rows of equal pattern on one rank form one
/// vertex: the six DOFs of a node of a shell, or its three of bending and its three in the plane if
/// these do not interact.
struct QuotientGraph {
  std::vector<int> vertex_of_row;  ///< [n]
  std::vector<int> n_rows;         ///< [n_vertices]
  Adjacency edges;                 ///< in both directions, even if the pattern has one

  int n_vertices() const { return static_cast<int>(n_rows.size()); }
};

/// Makes the quotient graph of a matrix.
/// @param A  [n x n] AIJ, symmetric, with the diagonal in its pattern
/// @return the same on all ranks
/// @note   Collective on the communicator of A.
QuotientGraph quotient_graph(Mat A);

}  // namespace chladni::linear
