#pragma once

#include <optional>

#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// The limit cycle at `speed` (rad/s) without a transient. It begins with the unstable eigenvector
/// of the sliding brake where its averaged growth ends (cycle_guess.hpp); harmonic balance brings
/// it near, shooting ends it. Where that leads nowhere, other amplitudes are tried, then the branch
/// from the Hopf point and a short transient (cycle_detours.hpp); `way` says which one it was.
/// @throws chladni::Error when the brake has no autonomous motion, when it is stable at this speed,
///         and, with what was tried, when
///         no start leads to a periodic motion.
DirectLimitCycle limit_cycle_direct(const Brake& brake, double speed);

/// The same from a given start, such as the cycle at a speed nearby; absent when Newton's method
/// does not converge or ends at rest.
std::optional<DirectLimitCycle> limit_cycle_near(const Brake& brake, double speed,
                                                 const CycleStart& start);

/// A cycle below this fraction of the compression of the first pad is taken for rest.
inline constexpr double cycle_at_rest = 1e-4;

}  // namespace chladni::squeal
