#pragma once

#include <Eigen/Core>

namespace chladni::linear {

/// A <- A - U S of a complex A = A^T, in its lower triangle, for a U of few columns and a U S that
/// is symmetric too. The work is that of reading the triangle once; Eigen's products would pack U
/// and S anew each time.
/// @param U  [n x k]
/// @param S  [k x n]
/// @param A  [n x n]; what stands above the diagonal is not used
/// @return [n] norms of the columns of what is left
Eigen::VectorXd subtract_from_symmetric(const Eigen::MatrixXcd& U, const Eigen::MatrixXcd& S,
                                        Eigen::MatrixXcd& A);

/// The same norms without changing A.
Eigen::VectorXd norms_without(const Eigen::MatrixXcd& U, const Eigen::MatrixXcd& S,
                              const Eigen::MatrixXcd& A);

/// A B of a complex A = A^T of which the lower triangle is known.
Eigen::MatrixXcd symmetric_product(const Eigen::MatrixXcd& A, const Eigen::MatrixXd& B);

}  // namespace chladni::linear
