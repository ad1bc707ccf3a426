#pragma once

#include <Eigen/Core>

namespace chladni::fmu {

/// What becomes of modal coordinates and rates x = (q, q') in a step of h seconds under modal
/// forces f that are constant in it: x(t + h) = from_state x(t) + from_force f. Exact for every h.
struct Propagator {
  Eigen::MatrixXd from_state;  ///< [2n x 2n]
  Eigen::MatrixXd from_force;  ///< [2n x n]
};

/// Of q'' + C q' + diag(omega^2) q = f, by the exponential of [A, B; 0, 0] h; mode by mode where C
/// is diagonal. Works with omega = 0.
/// @param h  s, > 0
Propagator propagator(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double h);

}  // namespace chladni::fmu
