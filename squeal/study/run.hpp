#pragma once

#include <functional>
#include <string>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// Callback with the name of the current analysis and the fraction of the whole study that is done,
/// 0 to 1, by the usual shares of the analyses.
using RunProgress = std::function<void(const std::string& analysis, double whole)>;

/// Callbacks and storage for a long study.
struct StudyKeeping {
  RunProgress progress = {};
  Checkpoint* checkpoint = nullptr;  ///< checkpoint of the transient; see Keeping
  WavSpool* sound = nullptr;         ///< sound of the transient
  /// Called before the first analysis, and after each one while others are missing.
  std::function<void(const SquealResults&)> unfinished = {};
  SquealResults begin = {};  ///< results of an unfinished run of the same study, which are kept
};

/// Performs `options.analyses` on the brake. "limit-cycle" and "spectrum" run the transient that
/// they need. When a later analysis fails, the earlier results are returned with the reason in
/// SquealResults::failure and the missing analyses in SquealResults::missing.
/// @throws chladni::Error from `validate`, and from the first analysis.
SquealResults run(const Brake& brake, const StudyOptions& options,
                  const StudyKeeping& keeping = {});

}  // namespace chladni::squeal
