#pragma once

#include <complex>

#include "squeal/models/flexible_disc.hpp"
#include "squeal/results/stability_results.hpp"

namespace chladni::squeal {

/// First-order estimate of the error of a growth rate due to the body, 1/s. The errors of modal
/// frequencies and ring motions are multiplied by the sensitivities of the growth rate to them and
/// added without sign. Parts for which the body has no data are absent; so are all except
/// `left_out` when the oscillation is beyond the range of known errors. Where two eigenvalues
/// nearly coincide the sensitivities, and with them the estimate, are too large.
/// @param brake   brake with an inertial frame
/// @param speed   rad/s
/// @param lambda  eigenvalue of its state matrix at this speed; the nearest is taken
ErrorBudget growth_error_budget(const FlexibleDisc& brake, double speed,
                                const std::complex<double>& lambda);

/// The same of a critical speed, rad/s: errors of the growth rate there over its slope.
/// @param brake  brake with an inertial frame, critical within its range of speeds
ErrorBudget error_budget(const FlexibleDisc& brake, const CriticalSpeed& critical);

}  // namespace chladni::squeal
