#pragma once

#include "linear/dense/dense_solvers.hpp"

namespace chladni::linear {

/// Cholesky factor of K + sigma M R R^T M, with the round-off of K along R removed; sigma is of the
/// size of the lower eigenvalues.
/// @param K  [n x n], symmetric, positive definite on the complement of R
/// @param R  [n x r] with K R = 0, R^T M R = I; r may be 0
/// @throws chladni::Error when K is singular beyond R.
Eigen::LLT<Eigen::MatrixXd> deflated_factor(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                                            const Eigen::MatrixXd& R);

}  // namespace chladni::linear
