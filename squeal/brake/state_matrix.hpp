#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact_compliance.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Linearised contact of all pads about the sliding equilibrium. Modes of pads with a mass follow
/// those of the disc.
/// @param speed  rad/s, > 0
StackedContact linear_contact(const InertialDisc& disc, const PadSystem& pads, double speed);

/// State matrix A of x' = A x about the sliding equilibrium a = 0 with x = (diag(omega) a, p). All
/// entries have the unit 1/s, so that the eigenvalue problem is well scaled. Modes of pads with a
/// mass follow at the end of a and p.
/// @param speed  rad/s, > 0
/// @return [2 n x 2 n], n = n_modes + modes of the pads, 1/s
Eigen::MatrixXd state_matrix(const InertialDisc& disc, const SquealOptions& options, double speed);

}  // namespace chladni::squeal
