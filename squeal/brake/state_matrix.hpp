#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The contacts of all pads in small motions about the sliding equilibrium, modes of pads with a
/// mass after those of the disc.
StackedContact linear_contact(const InertialDisc& disc, const PadSystem& pads, double speed);

/// A of x' = A x about the sliding equilibrium a = 0, with x = (diag(omega) a, p): all entries have
/// the unit 1/s, which keeps the eigenvalue problem well scaled. Pads with a mass add their modes
/// at the end of a.
/// @param speed  rad/s, > 0
/// @return [2 n x 2 n], n = n_modes + modes of the pads, 1/s
Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed);

}  // namespace chladni::squeal
