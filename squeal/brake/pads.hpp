#pragma once

#include <Eigen/Core>

#include "squeal/brake/contact.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The contact of one pad pair of the scene with a ring of this radius (m).
PadContact pad_contact(const SquealOptions& options, const PadPair& pad, double radius);

/// Derivatives of (F_w, F_r, F_t) of one pad pair at the undeformed, sliding disc:
/// F = D_a (w, g_r, g_t) + D_p (w', g_r', g_t').
struct ContactDerivatives {
  Eigen::Matrix3d D_a;  ///< N/m, N, N m
  Eigen::Matrix3d D_p;  ///< N s/m, N s, N m s
};

/// The undeformed disc is in equilibrium for any speed > 0, since both pads of a pair are equal.
/// Exact to rounding (complex step).
ContactDerivatives contact_derivatives(const PadContact& pad, double speed);

}  // namespace chladni::squeal
