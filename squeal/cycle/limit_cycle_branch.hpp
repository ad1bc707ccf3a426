#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// The limit cycles at the speeds of `range`, on the branch that begins at the Hopf point: where
/// sliding loses its stability first, or regains it if it never loses it. The branch is followed
/// along its arc, through folds, from the small cycle beside that point (hopf_cycle.hpp) until it
/// leaves the range or ends at rest. Where it folds back, a speed has more than one cycle.
///
/// Where there is no Hopf point, or the branch does not reach the highest of the speeds at which
/// sliding is unstable, the branch through the cycle at that speed is followed in both directions;
/// `note` says so.
/// @return in the order along the branch, from its Hopf point, or from its end on the side of low
///         speeds; empty when the brake is stable at all speeds
/// @throws chladni::Error as `limit_cycle_direct` at that speed, when nothing begins at a Hopf
/// point.
LimitCycleBranch limit_cycle_branch(const Brake& brake, const SpeedRange& range,
                                    const Progress& progress = {});

}  // namespace chladni::squeal
