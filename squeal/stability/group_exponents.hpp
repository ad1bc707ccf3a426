#pragma once

#include "squeal/stability/near_groups.hpp"

namespace chladni::squeal {

/// Characteristic exponents of a group of states, with their error.
struct GroupExponents {
  Eigen::VectorXcd lambda;  ///< [g] 1/s
  double error;             ///< estimated error, 1/s
};

/// Characteristic exponents of y' = F(phi) y, phi = step t. For one state lambda is the mean of F.
/// For more states it follows from the eigenvalues mu of the product of exponentials of the Magnus
/// series of sixth order over one period T, lambda = ln mu / T; the time steps are halved until the
/// growth converges. Of the replicas lambda + i k step the one nearest to the mean of
/// Im(y* F y) / (y* y) is returned, which turns with the motion.
/// @param step  rad/s
GroupExponents group_exponents(const NearGroup& group, double step);

}  // namespace chladni::squeal
