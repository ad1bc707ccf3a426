#pragma once

#include "squeal/brake/disc.hpp"
#include "squeal/motion/oscillator_flow.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The options with a friction whose direction is defined at rest. Where a pad sticks, Coulomb's
/// law has a force but no formula for it, and no implicit step has a solution. Without a
/// regularisation in the scene eps is 1e-3 of the speed of sliding: a pad that sticks creeps by
/// about so much, and friction in sliding changes by eps^2 / 2 of itself.
/// @param speed  of the disc, rad/s
SquealOptions with_friction_at_rest(SquealOptions options, const Disc& disc, double speed);

/// Bound of the velocity (m/s) that free vibration from `start` gives the contact planes along
/// themselves, h / 2 sum_i omega_i |q_i| |(W_r,i, W_t,i)|, by the amplitudes of the slopes on the
/// first ring. Below the speed of sliding no pad can stick.
double surface_speed(const Disc& disc, double thickness, const ModalState& start);

}  // namespace chladni::squeal
