#pragma once

#include <optional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"

namespace chladni::squeal {

/// What a detour to a limit cycle came to.
struct Detour {
  std::optional<DirectLimitCycle> cycle;
  std::string said;  ///< how it went, in words that stand behind a comma
};

/// The limit cycle at `speed` on the branch that begins at the Hopf point nearest below, at which
/// sliding loses its stability; from a hundredth of the speed on.
Detour cycle_by_continuation(const Brake& brake, double speed);

/// The limit cycle that a short transient comes to, which begins with the unstable eigenvector and
/// moves the first pad by its compression: every hundred periods its last state, and the time in
/// which that comes back, start Newton's method; three thousand periods at most.
Detour cycle_by_transient(const Brake& brake, double speed);

}  // namespace chladni::squeal
