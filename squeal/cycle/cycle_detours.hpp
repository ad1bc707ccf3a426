#pragma once

#include <optional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// Result of an indirect search for a limit cycle.
struct Detour {
  std::optional<DirectLimitCycle> cycle;
  std::string said;  ///< outcome in words, to follow a comma
};

/// Searches the limit cycle at `speed` (rad/s) by continuation of the branch from the nearest Hopf
/// point below, at which sliding loses its stability, down to a hundredth of the speed.
Detour cycle_by_continuation(const Brake& brake, double speed);

/// Searches the limit cycle at `speed` (rad/s) by a short transient. It starts with the unstable
/// eigenvector at an amplitude that moves the first pad by its compression at rest. Every hundred
/// periods its state and the time after which the state nearly recurs start Newton's method; it
/// ends after three thousand periods.
Detour cycle_by_transient(const Brake& brake, double speed);

}  // namespace chladni::squeal
