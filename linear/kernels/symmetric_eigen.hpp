#pragma once

#include <vector>

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// Eigenvalues, ascending, and orthonormal eigenvectors of a small symmetric matrix (LAPACK
/// dsyevd). Where a gap parts large diagonal entries from all others, as of a heavy mass or of a
/// shift close to an eigenvalue, the small eigenvalues keep their digits: their coupling to the
/// large ones is rotated away first.
struct SymmetricEigen {
  std::vector<double> values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(Eigen::MatrixXd A);

/// The same, computed by the first rank and told to the others: what ranks decide by eigenvalues
/// that each computed for itself may differ by round-off, and then they wait for each other.
/// @param A  of one size on all ranks
/// @note   Collective.
SymmetricEigen symmetric_eigen(Eigen::MatrixXd A, MPI_Comm comm);

}  // namespace chladni::linear
