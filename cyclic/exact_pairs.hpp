#pragma once

#include <Eigen/Core>

namespace chladni::cyclic {

/// Modes in pairs: mode 2 i + 1 is mode 2 i a quarter of a period later.
struct ExactPairs {
  /// [n x n_paired] orthonormal: each paired mode as a combination of the given ones
  Eigen::MatrixXd W;
  /// [n_paired] rad/s, the same for both modes of a pair
  Eigen::VectorXd omega;
};

/// Separates the pairs of modes that a solver returns in any mixture. A mode without its partner is
/// left out.
/// @param omega  [n] ascending, rad/s
/// @param S      [n x n] Phi^T M J Phi, skew: the modes under the quarter-period shift J
ExactPairs exact_pairs(const Eigen::VectorXd& omega, const Eigen::MatrixXd& S);

}  // namespace chladni::cyclic
