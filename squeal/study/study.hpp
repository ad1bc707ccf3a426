#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/stability/hill_table.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

/// Callback with the name of the current analysis and the fraction of the whole study that is done,
/// 0 to 1, by the usual shares of the analyses.
using RunProgress = std::function<void(const std::string& analysis, double whole)>;

/// Callbacks and storage for a long study.
struct StudyKeeping {
  RunProgress progress = {};
  WavRecording* sound = nullptr;  ///< sound of the transient
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

/// A brake and the options of its study.
struct Study {
  const Brake& brake;
  const StudyOptions& options;
  TurningTables& turning;  ///< shared by the analyses of a disc that is not axisymmetric
};

/// Implementation of an analysis of analysis_options.hpp.
struct AnalysisStep {
  std::string_view name;
  double share;                          ///< usual share of the time of a run, in any unit
  std::vector<std::string_view> serves;  ///< other analyses that use its result
  /// Performs the analysis and adds its result. An analysis that needs a body is only called for a
  /// brake with one.
  void (*perform)(const Study&, SquealResults&, const Keeping&);
};

/// The steps of all analyses, in the order in which they are performed.
std::span<const AnalysisStep> analysis_steps();

/// Checks the options of a study, each value and their combination for the analyses asked for, and
/// those of a brake with a body.
/// @throws chladni::Error naming the key of the scene, the value and what is allowed.
void validate(const Brake& brake, const StudyOptions& study);

}  // namespace chladni::squeal
