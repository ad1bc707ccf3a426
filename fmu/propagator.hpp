#pragma once

#include <Eigen/Core>

namespace chladni::fmu {

/// Exact step of modal coordinates and rates x = (q, q') over the time h under modal forces f that
/// are constant during the step: x(t + h) = from_state x(t) + from_force f.
struct Propagator {
  Eigen::MatrixXd from_state;  ///< [2n x 2n]
  Eigen::MatrixXd from_force;  ///< [2n x n]
};

/// The propagator of q'' + C q' + diag(omega^2) q = f from the matrix exponential of h [A, B; 0,
/// 0], mode by mode when C is diagonal. omega = 0 is allowed.
/// @param h  step size, s, > 0
Propagator propagator(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double h);

}  // namespace chladni::fmu
