#pragma once

#include <string>

#include "squeal/results/cycle_results.hpp"

namespace chladni::squeal {

/// Adds the points and folds of a part that goes on where the branch ends.
void append(LimitCycleBranch& branch, const LimitCycleBranch& part);

/// The branch with another part behind it. Where both have a cycle in common they are one branch,
/// of which the first one has lost a cycle: the longer one takes the place of the other.
/// @param note  of the branch where the parts have no cycle in common
LimitCycleBranch joined(LimitCycleBranch first, LimitCycleBranch second, const std::string& note);

}  // namespace chladni::squeal
