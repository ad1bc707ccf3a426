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

/// A brake and what is to be found out about it.
struct Study {
  const Brake& brake;
  const StudyOptions& options;
  TurningTables& turning;  ///< what several analyses of a disc that is not axisymmetric need
};

/// How an analysis of analysis_options.hpp is done.
struct AnalysisStep {
  std::string_view name;
  double share;                          ///< of the time of a run, usually, in any unit
  std::vector<std::string_view> serves;  ///< other analyses that begin with its result
  /// Adds its result; of an analysis that needs a body, the brake has one.
  void (*perform)(const Study&, SquealResults&, const Keeping&);
};

/// The steps of all analyses, in the order in which they are done.
std::span<const AnalysisStep> analysis_steps();

}  // namespace chladni::squeal
