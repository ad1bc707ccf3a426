#pragma once

#include <optional>

#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The limit cycle at `speed` (rad/s) without a transient. The search starts with the unstable
/// eigenvector of the sliding brake at the amplitude where its averaged growth vanishes
/// (cycle_guess.hpp), refines it by harmonic balance and then by shooting. If that fails, it tries
/// other amplitudes, then the branch from the Hopf point and a short transient (cycle_detours.hpp);
/// `way` names the successful start.
/// @throws chladni::Error when the brake has no autonomous motion, when it is stable at this speed,
///         and, with a list of the attempts, when none leads to a periodic motion.
DirectLimitCycle limit_cycle_direct(const Brake& brake, double speed);

/// The limit cycle at `speed` (rad/s) from a given start, such as the cycle at a nearby speed;
/// absent when Newton's method does not converge or ends at rest.
std::optional<DirectLimitCycle> limit_cycle_near(const Brake& brake, double speed,
                                                 const CycleStart& start);

/// Amplitude relative to the compression of the first pad below which a cycle counts as rest.
inline constexpr double cycle_at_rest = 1e-4;

}  // namespace chladni::squeal
