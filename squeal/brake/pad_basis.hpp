#pragma once

#include <Eigen/Core>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Modes of plates and calipers in mass-scaled displacements, y = Psi b. Psi diag(omega) Psi^T is
/// the square root of their stiffness matrix.
/// @return [n_pad_modes x n_pad_modes] orthogonal
Eigen::MatrixXd pad_basis(const SquealOptions& options);

/// The state matrix in coordinates that depend smoothly on the pad parameters: (K^(1/2) y, y') in
/// place of the pad modes, whose signs, and for equal plates whose combinations, are arbitrary. Its
/// eigenvalues are those of `state_matrix`.
Eigen::MatrixXd smooth_state_matrix(const InertialDisc& disc, const SquealOptions& options,
                                    double speed);

}  // namespace chladni::squeal
