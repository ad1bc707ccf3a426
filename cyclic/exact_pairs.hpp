#pragma once

#include <Eigen/Core>

namespace chladni::cyclic {

/// Modes in pairs: mode 2 i + 1 is mode 2 i a quarter of a period later.
struct ExactPairs {
  Eigen::MatrixXd W;      ///< [n x n_paired] orthonormal: what each is of the modes given
  Eigen::VectorXd omega;  ///< [n_paired] rad/s, the same for both of a pair
};

/// Pairs of modes that a solver has found in any mixture.
/// @param omega  [n] ascending, rad/s
/// @param S      [n x n] Phi^T M J Phi, skew: what J makes of the modes
/// A mode whose partner is not among them is left out.
ExactPairs exact_pairs(const Eigen::VectorXd& omega, const Eigen::MatrixXd& S);

}  // namespace chladni::cyclic
