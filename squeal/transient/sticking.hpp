#pragma once

#include "squeal/brake/disc.hpp"
#include "squeal/motion/oscillator_flow.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The options with friction whose direction is defined at rest. For a sticking pad Coulomb's law
/// has no formula for the force, and an implicit step has no solution. If the scene has no
/// regularisation, eps is set to 1e-3 of the sliding speed: a sticking pad then creeps with about
/// this speed, and the friction in sliding changes relatively by eps^2 / 2.
/// @param speed  rotation speed of the disc, rad/s
SquealOptions with_friction_at_rest(SquealOptions options, const Disc& disc, double speed);

/// Upper bound of the in-plane velocity (m/s) of the contact planes in free vibration from `start`,
/// sum_i |(omega_i q_i, q'_i)| (h / 2 |(W_r,i, W_t,i)| + |(V_r,i, V_t,i)|), with the amplitudes on
/// the first ring. If it is below the sliding speed, no pad can stick.
/// @param thickness  h, m
double surface_speed(const Disc& disc, double thickness, const ModalState& start);

}  // namespace chladni::squeal
