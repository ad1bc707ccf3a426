#pragma once

#include <vector>

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// Eigenvalues, ascending, and orthonormal eigenvectors of a small symmetric matrix.
struct SymmetricEigen {
  std::vector<double> values;
  Eigen::MatrixXd vectors;
};
/// The eigenpairs by LAPACK's dsyevd. If a gap separates large diagonal entries from all others, as
/// with a heavy mass or a shift close to an eigenvalue, the coupling of the small eigenvalues to
/// the large ones is rotated away first, so that they keep their digits. Sets of rows that A does
/// not couple are solved apart: vectors of one are zero in the others.
SymmetricEigen symmetric_eigen(Eigen::MatrixXd A);

/// The eigenpairs, computed by the first rank and sent to the others. Ranks that decide by
/// eigenvalues of their own could differ by round-off and wait for each other.
/// @param A  of the same size on all ranks
/// @note   Collective.
SymmetricEigen symmetric_eigen(Eigen::MatrixXd A, MPI_Comm comm);

}  // namespace chladni::linear
