#pragma once

#include <string>

#include "squeal/results/cycle_results.hpp"

namespace chladni::squeal {

/// Appends the points and folds of a part that continues the branch.
void append(LimitCycleBranch& branch, const LimitCycleBranch& part);

/// Joins two parts of a branch. If they have a cycle in common they are the same branch, part of
/// which the first has missed, and the longer one is returned. Otherwise the second is appended as
/// a second part.
/// @param note  note of the branch when the parts have no cycle in common
LimitCycleBranch joined(LimitCycleBranch first, LimitCycleBranch second, const std::string& note);

}  // namespace chladni::squeal
