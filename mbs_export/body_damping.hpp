#pragma once

#include <Eigen/Core>

#include "mbs_export/body_options.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Modes in the coordinates of a reduced system, whose mass matrix is I and whose stiffness is
/// diag(omega^2).
struct BodyCoordinates {
  const Eigen::VectorXd& omega;  ///< [n_modes] rad/s
  const Eigen::MatrixXd& T;      ///< [n_FE x n_modes]
};

/// The damping of a body: in harmonic motion q'' + C q' + (diag(omega^2) + i H) q. Solvers in time
/// use `C` alone, which includes the viscous equivalent of H.
struct BodyDamping {
  Eigen::MatrixXd C = {};  ///< [n_modes x n_modes] 1/s, or [0 x 0]
  Eigen::MatrixXd H = {};  ///< [n_modes x n_modes] 1/s^2, or [0 x 0]
};

/// diag(omega)^-1/2 H diag(omega)^-1/2: symmetric and semidefinite as H is, and zero for modes
/// without stiffness. At the frequency of each mode it dissipates as H does, C_ii = eta_i omega_i,
/// and also in all combinations of modes of one frequency, where it is H / omega. Between modes of
/// different frequency it uses the geometric mean of both.
/// @return [n_modes x n_modes], 1/s
Eigen::MatrixXd viscous_equivalent(const Eigen::MatrixXd& H, const Eigen::VectorXd& omega);

/// The damping matrices of a body.
/// @throws BodyOptionError when the number of ratios is not that of the modes, a mode lies beyond
///         the table of ratios, or `matrix` is asked for and the system has no damping matrices.
BodyDamping body_damping(const ReducedSystem& reduced, const BodyCoordinates& modes,
                         const Damping& damping);

}  // namespace chladni::mbs_export
