#pragma once

#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Largest relative change of the envelope over the last tenth of a run that counts as settled.
inline constexpr double settled_drift = 1e-3;

/// The limit cycle at the end of a transient; frequency from interpolated zero crossings
/// of the pad velocity over the whole tail. Look at `settled` before you trust it.
/// @throws chladni::Error when the transient diverged or is shorter than its tail.
LimitCycle limit_cycle(const Transient& transient);

/// Whether the end of the transient in these results is known to be no limit cycle, nor what was
/// computed from it.
bool has_unsettled_end(const SquealResults& results);

}  // namespace chladni::squeal
