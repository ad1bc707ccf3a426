#pragma once

#include <functional>
#include <string>
#include <vector>

#include "squeal/study/run.hpp"

namespace chladni::squeal {

/// An analysis and the names in the scene of all that need it.
struct StudyStep {
  std::vector<std::string> names;
  std::function<void(SquealResults&, const Keeping&)> perform;
};

/// Performs those of the steps, in their order, that `analyses` ask for.
/// @param results  with what is known before the first analysis
/// @throws chladni::Error from the first analysis.
SquealResults perform_steps(const std::vector<StudyStep>& steps,
                            const std::vector<std::string>& analyses, SquealResults results,
                            const StudyKeeping& keeping);

}  // namespace chladni::squeal
