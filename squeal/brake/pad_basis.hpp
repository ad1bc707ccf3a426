#pragma once

#include <Eigen/Core>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// [n_pad_modes x n_pad_modes] orthogonal: the modes of plates and calipers in their displacements
/// times the roots of their masses, y = Psi b. Psi diag(omega) Psi^T is the root of their
/// stiffness.
Eigen::MatrixXd pad_basis(const SquealOptions& options);

/// The state matrix in coordinates that follow the parameters of the pads smoothly, with
/// (K^(1/2) y, y') in place of the modes of the pads: these come with any sign, and in any
/// combination where plates are alike. Its eigenvalues are those of `state_matrix`.
Eigen::MatrixXd smooth_state_matrix(const InertialDisc& disc, const SquealOptions& options,
                                    double speed);

}  // namespace chladni::squeal
