#pragma once

#include <Eigen/Core>

#include "mbs_export/body_options.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Modes whose mass matrix is I and whose stiffness is diag(omega^2), in the coordinates of a
/// reduced system.
struct BodyCoordinates {
  const Eigen::VectorXd& omega;  ///< [n_modes] rad/s
  const Eigen::MatrixXd& T;      ///< [n_FE x n_modes]
};

/// The damping of a body: q'' + C q' + (diag(omega^2) + i H) q at a harmonic motion, of which
/// solvers in time take `C` alone, with the viscous equivalent of H in it.
struct BodyDamping {
  Eigen::MatrixXd C = {};  ///< [n_modes x n_modes] 1/s, or [0 x 0]
  Eigen::MatrixXd H = {};  ///< [n_modes x n_modes] 1/s^2, or [0 x 0]
};

/// diag(omega)^-1/2 H diag(omega)^-1/2, symmetric and semidefinite as H is, and zero for modes
/// without stiffness. It dissipates in each mode at its own frequency what H does there,
/// C_ii = eta_i omega_i, and so in all combinations of modes of one frequency, H / omega; of modes
/// apart it takes the geometric mean of both frequencies.
Eigen::MatrixXd viscous_equivalent(const Eigen::MatrixXd& H, const Eigen::VectorXd& omega);

/// @throws BodyOptionError for a number of ratios that is not that of the modes, modes beyond a
///         table of ratios, and a system without damping matrices where `matrix` asks for them.
BodyDamping body_damping(const ReducedSystem& reduced, const BodyCoordinates& modes,
                         const Damping& damping);

}  // namespace chladni::mbs_export
