#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/stability/turning_table.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

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

}  // namespace chladni::squeal
