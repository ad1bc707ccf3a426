#pragma once

#include "squeal/stability/near_groups.hpp"

namespace chladni::squeal {

/// Characteristic exponents of a group, and how well they are known.
struct GroupExponents {
  Eigen::VectorXcd lambda;  ///< [g] 1/s
  double error;             ///< estimated, 1/s
};

/// Of y' = F(phi) y, phi = step t: the mean of F for one state; for more, by the eigenvalues mu of
/// the product of exponentials of Magnus' series of sixth order over one period T, lambda = ln mu /
/// T. The steps are halved until the growth changes no more. Of the replicas lambda + i k step that
/// one is given which turns with the motion, i.e. the nearest to the mean of Im(y* F y) / (y* y).
GroupExponents group_exponents(const NearGroup& group, double step);

}  // namespace chladni::squeal
