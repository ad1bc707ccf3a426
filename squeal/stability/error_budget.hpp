#pragma once

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// How far a critical speed may be off because of what its body is made of. First order: errors of
/// the frequencies of modes go through the sensitivities of the critical speed to them, added
/// without sign. Parts of which the body tells nothing are absent: all but `left_out` where the
/// critical oscillation is beyond the range whose errors it knows.
/// @param brake  in whose range of speeds it is critical; with an inertial frame
ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical);

}  // namespace chladni::squeal
