#pragma once

#include <Eigen/Core>

#include "mbs_export/body_options.hpp"
#include "mbs_export/modal_body.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// The modal body of a reduced system: free modes are orthogonalised, displacements are held by
/// mode shifting, the modes of the held body are computed, some of them are kept, and interface
/// modes represent the others. M_m = I and K_m = diag(omega^2), since modes and interface modes are
/// orthogonal. A body that is not held, or not completely (`n_free_rigid`), keeps its rigid-body
/// motions.
/// @throws chladni::Error for a set, component or mode that does not exist, for displacements that
///         cannot be held together, and for damping that does not fit.
ModalBody make_body(const ReducedSystem& reduced, const BodyOptions& options);

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

/// A body that moves only in the given shapes: Rayleigh-Ritz vectors V of its stiffness over them,
/// V^T V = I and V^T diag(omega^2) V = diag(omega_r^2), take the place of its modes. Everything the
/// body knows of its modes is carried over (attachment motions, rings, picture, damping, section
/// forces, integrals over the mass); the certificate stays that of the reduced system. A vector
/// that is no mode of the body is of kind `interface`.
/// @param shapes  [n_modes x k] linear combinations of the modes; those that depend on others to
///                within 1e-10 are dropped
/// @return at most k modes, ascending
/// @throws chladni::Error when no shape is left, or when there is not a row for each mode.
ModalBody condensed(const ModalBody& body, const Eigen::MatrixXd& shapes);

}  // namespace chladni::mbs_export
