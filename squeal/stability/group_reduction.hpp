#pragma once

#include <variant>
#include <vector>

#include "squeal/stability/near_groups.hpp"

namespace chladni::squeal {

/// Indices in `TurningModes`, ascending.
using States = std::vector<Eigen::Index>;

/// Two states that must be in one group.
struct Link {
  Eigen::Index i, j;
};

/// An invariant group, or what stands against it.
using Reduced = std::variant<NearGroup, Link>;

/// For each of `groups` the fixed-point iteration of `near_groups`; they are disjoint.
std::vector<Reduced> reduced(const TurningModes& modes, double tolerance,
                             const std::vector<States>& groups);

}  // namespace chladni::squeal
