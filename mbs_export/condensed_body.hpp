#pragma once

#include <Eigen/Core>

#include "mbs_export/modal_body.hpp"

namespace chladni::mbs_export {

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
