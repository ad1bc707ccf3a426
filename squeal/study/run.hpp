#pragma once

#include <functional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// Called with the name of the analysis under way and the part of the whole study that is done, 0
/// to 1, where each analysis counts the same.
using RunProgress = std::function<void(const std::string& analysis, double whole)>;

/// What goes along with a long study.
struct StudyKeeping {
  RunProgress progress = {};
  Checkpoint* checkpoint = nullptr;  ///< of the transient; see Keeping
  WavSpool* sound = nullptr;         ///< of the transient
  /// Called before the first analysis and after each one while others are missing.
  std::function<void(const SquealResults&)> unfinished = {};
  SquealResults begin = {};  ///< of an unfinished run of the same study: what it has is not redone
};

/// Performs `options.analyses` on the brake. "limit-cycle" and "spectrum" run the transient that
/// they need. What was found stays when a later analysis fails; SquealResults::failure then says
/// why, and SquealResults::missing what is not there.
/// @throws chladni::Error from `validate` and from the first analysis.
SquealResults run(const Brake& brake, const StudyOptions& options,
                  const StudyKeeping& keeping = {});

}  // namespace chladni::squeal
