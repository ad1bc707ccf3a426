#pragma once

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

}  // namespace chladni::linear
