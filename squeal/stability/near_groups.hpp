#pragma once

#include <optional>
#include <vector>

#include "squeal/stability/turning_brake.hpp"

namespace chladni::squeal {

/// A group of states of `TurningModes` with close frequencies, and the coupling to all other
/// states: y_q = X(phi) y_g is invariant, so that y_g' = F(phi) y_g holds exactly except for the
/// truncation of the harmonics of X.
struct NearGroup {
  std::vector<Eigen::Index> states;
  bool has_mirror;        ///< the complex conjugate states form another group, which is not listed
  AngleHarmonics F;       ///< [g g x N] 1/s, each column a matrix
  Eigen::Index highest;   ///< highest harmonic of X
  double error;           ///< error estimated from the last harmonics, 1/s
  AngleHarmonics X = {};  ///< [m g x N], zero in the rows of the group; empty of an estimate
  double doubt = 0.0;     ///< of an estimate by the second order of B, 1/s; 0: it is none
};

/// Which groups are solved.
struct GroupsAsked {
  /// Those alone that may hold one of so many motions that grow most, each by the second order of B
  /// and its doubt.
  Eigen::Index least_stable;
  /// Beside them those that may grow, and the estimates of all others.
  bool with_estimates = false;
};

/// Columns of X for which `near_groups` iterates at a time; a larger group has more.
inline constexpr Eigen::Index columns_iterated = 32;

/// Refuses, before it is taken, what would fill the memory of the machine.
/// @param step     rad/s, nu times the speed
/// @param m        states
/// @param N        angles
/// @param columns  of X
/// @throws chladni::Error
void require_room(double step, Eigen::Index m, Eigen::Index N,
                  Eigen::Index columns = columns_iterated);

/// Splits the states into invariant groups. X solves the harmonic balance of
///   step dX/dphi = Lambda_q X - X Lambda_g + B_qg + B_qq X - X (B_gg + B_gq X)
/// by a fixed-point iteration, in which each harmonic is divided by i k step - lambda_i + lambda_j,
/// with Anderson's acceleration (Journal of the ACM 12, 1965, pages 547 to 560) where it is slow.
/// If it does not converge, or needs too many harmonics for the error `tolerance` (1/s), the two
/// states responsible are put into one group.
/// @param asked  without it, and with estimates, each state is in a group or in the mirror image of
///               one
std::vector<NearGroup> near_groups(const TurningModes& modes, double tolerance,
                                   std::optional<GroupsAsked> asked = {});

}  // namespace chladni::squeal
