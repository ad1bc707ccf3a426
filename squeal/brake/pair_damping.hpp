#pragma once

#include <Eigen/Core>

#include "squeal/brake/inertial_frame.hpp"

namespace chladni::squeal {

/// Mean over the circumference of exp(-phi D) C exp(phi D) for damping or Coriolis terms, exact
/// because more than 2 n_max + 1 angles are used.
/// @param C  [n_modes x n_modes] in the coordinates of the inertial disc
Eigen::MatrixXd averaged_over_angles(const InertialDisc& inertial, const Eigen::MatrixXd& C);

/// Differences within the pairs that the mean over the circumference removes.
struct DampingDifference {
  double spread = 0.0;    ///< largest difference of decay rates within a pair, 1/s
  double contrast = 0.0;  ///< largest difference relative to the pair's mean decay rate
};

/// Differences within each pair: half the distance of the eigenvalues of its block of C.
DampingDifference damping_difference(const InertialDisc& inertial, const Eigen::MatrixXd& C);

}  // namespace chladni::squeal
