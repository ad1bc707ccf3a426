#pragma once

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// First-order estimate of the error of a critical speed due to the body. The errors of modal
/// frequencies and ring motions are multiplied by the sensitivities of the critical speed to them
/// and added without sign. Parts for which the body has no data are absent; so are all except
/// `left_out` when the critical oscillation is beyond the range of known errors.
/// @param brake  brake with an inertial frame, critical within its range of speeds
ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical);

}  // namespace chladni::squeal
