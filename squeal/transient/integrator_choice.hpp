#pragma once

#include <optional>
#include <string>

#include "squeal/brake/disc.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/motion/splitting.hpp"

namespace chladni::squeal {

/// Integration method of a transient with its parameters.
struct IntegratorChoice {
  IntegratorKind kind;  ///< never `automatic`
  /// Steps per period of the highest mode; for adaptive methods the minimum.
  int steps_per_period;
  double tolerance;    ///< for adaptive methods: error of a step relative to |y|
  std::string reason;  ///< reason of the choice, for the user
};

/// The integrator of the scene, or for "auto" the cheapest one within `growth_error`. It is
/// "generalised-alpha" when the disc with its pads at rest is stiff, that is, when a motion decays
/// faster than the highest mode oscillates, or becomes stiff because the start of the run may stop
/// a pad on the disc. Otherwise it is "exponential" for an axisymmetric disc. Otherwise it is
/// "splitting", unless its step would be so small that "dormand-prince" costs less. The error of a
/// step size is that of the eigenvalues of the discretised motion near the sliding equilibrium.
/// @throws chladni::Error when "exponential" is asked for and the disc is not axisymmetric.
IntegratorChoice choose_integrator(const Disc& disc, const std::optional<InertialDisc>& inertial,
                                   const SquealOptions& options, const TransientCase& run);

/// The name in the scene, such as "splitting".
const char* name_of(IntegratorKind kind);

/// Largest error (1/s) of a growth rate near the sliding equilibrium by steps of the splitting or
/// of the generalised-alpha method; 0 for other methods. Exact for the splitting, the leading term
/// for generalised-alpha.
/// @param speed  rad/s
double growth_error_of(IntegratorKind kind, const InertialDisc& disc, const SquealOptions& options,
                       double speed, int steps_per_period);

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

/// Initial state of `transient`: the pads at `angle` (rad) are displaced by
/// `initial_pad_displacement`.
ModalState transient_start(const Disc& disc, const std::optional<InertialDisc>& inertial,
                           const TransientCase& run, double angle);

}  // namespace chladni::squeal
