#pragma once

#include <vector>

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// A B.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A^-1 B for any regular A, by LU with pivoting.
/// @throws chladni::Error when A is singular.
Eigen::MatrixXd solution(Eigen::MatrixXd A, Eigen::MatrixXd B);

/// [A; B].
Eigen::MatrixXd stacked(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Y <- beta Y + alpha X S for column-major local rows X [n_local x rows of S], Y.
void add_product(double alpha, const double* X, PetscInt n_local, const Eigen::MatrixXd& S,
                 double beta, double* Y);

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
