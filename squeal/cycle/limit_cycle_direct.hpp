#pragma once

#include <optional>

#include "squeal/brake/disc.hpp"
#include "squeal/cycle/cycle_problem.hpp"
#include "squeal/cycle/periodic_orbit.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The limit cycle at `speed` (rad/s) without a transient. It begins with the unstable eigenvector
/// of the sliding disc where its averaged growth ends (cycle_guess.hpp); harmonic balance brings it
/// near, shooting ends it.
/// @throws chladni::Error when the disc is not axisymmetric, when it is stable at this speed, and
///         when no start leads to a periodic motion.
DirectLimitCycle limit_cycle_direct(const CycleProblem& problem, double speed);
DirectLimitCycle limit_cycle_direct(const Disc& disc, const SquealOptions& options, double speed);

/// The same from a given start, such as the cycle at a speed nearby; absent when Newton's method
/// does not converge or ends at rest.
std::optional<DirectLimitCycle> limit_cycle_near(const CycleProblem& problem, double speed,
                                                 const CycleStart& start);
std::optional<DirectLimitCycle> limit_cycle_near(const Disc& disc, const SquealOptions& options,
                                                 double speed, const CycleStart& start);

/// A cycle below this fraction of the compression of the first pad is taken for rest.
inline constexpr double cycle_at_rest = 1e-4;

}  // namespace chladni::squeal
