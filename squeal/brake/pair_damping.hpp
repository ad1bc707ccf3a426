#pragma once

#include <Eigen/Core>

#include "squeal/brake/inertial_frame.hpp"

namespace chladni::squeal {

/// Mean over the circumference of exp(-phi D) C exp(phi D), of damping or Coriolis terms, exact
/// with more than 2 n_max + 1 angles.
/// @param C  [n_modes x n_modes] in the coordinates of the inertial disc
Eigen::MatrixXd averaged_over_angles(const InertialDisc& inertial, const Eigen::MatrixXd& C);

/// What the mean takes from the pairs.
struct DampingDifference {
  double spread = 0.0;    ///< largest difference of the decay rates of the two modes of a pair, 1/s
  double contrast = 0.0;  ///< the same over the mean rate of the pair
};

/// Each pair by itself: the distance of the eigenvalues of its block of C, halved.
DampingDifference damping_difference(const InertialDisc& inertial, const Eigen::MatrixXd& C);

}  // namespace chladni::squeal
