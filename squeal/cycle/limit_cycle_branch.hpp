#pragma once

#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/limit_cycle_results.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// The limit cycles at the speeds of `range` on the branch that starts at the Hopf point: the
/// lowest speed where sliding loses its stability or, if it never does, regains it. The branch is
/// followed along its arc, through folds, from the small cycle near that point (hopf_cycle.hpp)
/// until it leaves the range or ends at rest. Where it folds back, a speed has more than one cycle.
///
/// If there is no Hopf point, or the branch does not reach the highest speed at which sliding is
/// unstable, the branch through the cycle at that speed is followed in both directions, and `note`
/// says so.
/// @return cycles in the order along the branch, from the Hopf point or from the end at low speeds;
///         empty when the brake is stable at all speeds
/// @throws chladni::Error as `limit_cycle_direct` at that speed, when no branch starts at a Hopf
///         point.
LimitCycleBranch limit_cycle_branch(const Brake& brake, const SpeedRange& range,
                                    const Progress& progress = {});

/// Appends the points and folds of a part that continues the branch.
void append(LimitCycleBranch& branch, const LimitCycleBranch& part);

/// Joins two parts of a branch. If they have a cycle in common they are the same branch, part of
/// which the first has missed, and the longer one is returned. Otherwise the second is appended as
/// a second part.
/// @param note  note of the branch when the parts have no cycle in common
LimitCycleBranch joined(LimitCycleBranch first, LimitCycleBranch second, const std::string& note);

}  // namespace chladni::squeal
