#pragma once

#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// Largest relative change of the envelope over the last tenth of a transient that counts as
/// settled.
inline constexpr double settled_drift = 1e-3;

/// The limit cycle at the end of a transient. Its frequency is computed from interpolated zero
/// crossings of the pad velocity over the whole tail. Check `settled` before use.
/// @throws chladni::Error when the transient diverged or is shorter than its tail.
LimitCycle limit_cycle(const Transient& transient);

/// Whether the results contain a limit cycle at the end of a transient that has not settled.
bool has_unsettled_end(const SquealResults& results);

}  // namespace chladni::squeal
