#pragma once

#include <Eigen/Core>
#include <complex>

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_table.hpp"

namespace chladni::squeal {

/// Work per period of the motion Re(u exp(lambda t)) of the sliding brake at a speed (rad/s), from
/// its linearised contact forces.
/// @param u  eigenvector of the state matrix for the oscillating eigenvalue lambda
PeriodWork period_work(const FlexibleDisc& brake, double speed, std::complex<double> lambda,
                       const Eigen::VectorXcd& u);

}  // namespace chladni::squeal
