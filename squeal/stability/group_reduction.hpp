#pragma once

#include <variant>
#include <vector>

#include "squeal/stability/near_groups.hpp"

namespace chladni::squeal {

/// Indices of states in `TurningModes`, ascending.
using States = std::vector<Eigen::Index>;

/// Two states that must belong to one group.
struct Link {
  Eigen::Index i, j;
};

/// An invariant group, or the link that prevents it.
using Reduced = std::variant<NearGroup, Link>;

/// Performs the fixed-point iteration of `near_groups` for each of the disjoint `groups`.
/// @param tolerance  1/s
std::vector<Reduced> reduced(const TurningModes& modes, double tolerance,
                             const std::vector<States>& groups);

}  // namespace chladni::squeal
