#pragma once

#include <vector>

#include "squeal/stability/turning_modes.hpp"

namespace chladni::squeal {

/// Some of the states of `TurningModes`, near each other in frequency, with what they need of all
/// the others: y_q = X(phi) y_g is invariant, so that y_g' = F(phi) y_g holds without an
/// approximation but the truncation of X to so many harmonics.
struct NearGroup {
  std::vector<Eigen::Index> states;
  bool has_mirror;       ///< the complex conjugate states are another group, which is not listed
  AngleHarmonics F;      ///< [g g x N] 1/s, each column a matrix
  Eigen::Index highest;  ///< harmonic kept of X
  double error;          ///< estimated from the last harmonics kept, 1/s
};

/// Splits the states into invariant groups. X solves the harmonic balance of
///   step dX/dphi = Lambda_q X - X Lambda_g + B_qg + B_qq X - X (B_gg + B_gq X)
/// by fixed-point iteration, each harmonic divided by i k step - lambda_i + lambda_j. Where this
/// does not converge, or needs more harmonics than there are for an error of `tolerance` (1/s), the
/// two states that stand against it go into one group. All states are in a group or in the mirror
/// image of one.
std::vector<NearGroup> near_groups(const TurningModes& modes, double tolerance);

}  // namespace chladni::squeal
