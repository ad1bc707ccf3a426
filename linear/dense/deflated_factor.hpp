#pragma once

#include "linear/dense/dense_solvers.hpp"

namespace chladni::linear {

/// A stiffness-to-mass ratio of the lower modes: the smallest K_ii / M_ii that is no round-off, in
/// K or in M; 1 where there is none.
/// @param R  [n x r] with K R = 0, R^T M R = I; r may be 0
double deflation_shift(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                       const Eigen::MatrixXd& R);

/// Cholesky factor of K + sigma M R R^T M, with the round-off of K along R removed.
/// @param K      [n x n], symmetric, positive definite on the complement of R
/// @param R      [n x r] with K R = 0, R^T M R = I; r may be 0
/// @param sigma  of the size of the lower eigenvalues: deflation_shift() of the whole problem
/// @throws chladni::Error when K is singular beyond R: not positive definite, or positive by
///         round-off along a motion without mass.
Eigen::LLT<Eigen::MatrixXd> deflated_factor(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M,
                                            const Eigen::MatrixXd& R, double sigma);

}  // namespace chladni::linear
