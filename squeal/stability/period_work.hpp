#pragma once

#include <Eigen/Core>
#include <complex>

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_table.hpp"

namespace chladni::squeal {

/// The works in a period of the motion Re(u exp(lambda t)) of the sliding brake at a speed (rad/s),
/// from the forces of its contacts over the phases of a motion so small that they are linear.
/// @param u  eigenvector of the state matrix for lambda, which oscillates
PeriodWork period_work(const FlexibleDisc& brake, double speed, std::complex<double> lambda,
                       const Eigen::VectorXcd& u);

}  // namespace chladni::squeal
