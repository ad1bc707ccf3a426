#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// The limit cycles at the speeds of `range`, on the branch that begins at the highest of them at
/// which the sliding brake is unstable. The branch is followed along its arc, through folds, to
/// lower speeds until it leaves the range or ends at rest, and then to higher ones. Where it folds
/// back, a speed has more than one cycle.
/// @return in the order along the branch, from its end on the side of low speeds; empty when the
///         brake is stable at all speeds
/// @throws chladni::Error as `limit_cycle_direct` at the first speed.
LimitCycleBranch limit_cycle_branch(const Brake& brake, const SpeedRange& range,
                                    const Progress& progress = {});

}  // namespace chladni::squeal
