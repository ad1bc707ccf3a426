#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "cases/phases.hpp"
#include "linear/solver_options.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// What `chladni compare` tries.
struct ReductionTrials {
  int n_frequencies = 20;                               ///< elastic ones of the supported body
  std::vector<int> modes = {10, 20, 40, 80, 160};       ///< of each method
  std::vector<double> tolerances = {1e-2, 1e-3, 1e-4};  ///< of Craig-Bampton
};

/// One reduction beside the FE model.
struct ComparedReduction {
  std::string method;
  std::string asked;      ///< "40 modes", "tolerance 0.001", or nothing
  int n_coordinates = 0;  ///< of the reduced system
  int n_compared = 0;     ///< frequencies that both have
  double error = 0.0;     ///< largest relative error of these
  double told = 0.0;      ///< largest error that the reduction estimates of these; 0: not of all
  double cpu_s = 0.0;     ///< from the factorisation on, of all ranks
  double wall_s = 0.0;
  std::string refusal = {};  ///< why there is no such reduction; then all else is 0
  /// No other one has a smaller error for no more CPU time, or for no more coordinates.
  bool is_best_in_time = false, is_best_in_size = false;
};

/// Methods and numbers of modes on one model.
struct ReductionComparison {
  Eigen::VectorXd omega;  ///< rad/s, elastic frequencies of the supported FE model
  int n_dofs;
  double modes_cpu_s;  ///< of the natural modes of the FE model, of all ranks
  std::vector<ComparedReduction> reductions;
};

/// Reduces the scene's model by every method with these numbers of modes, and compares the
/// frequencies under the supports of the body with those of the FE model. Each reduction is made by
/// itself, from the mesh on; only what belongs to the reduction counts as its time.
/// @note   Collective on all ranks.
/// @throws chladni::Error on all ranks alike, when the FE model cannot be solved.
ReductionComparison compare_reductions(const scene::Scene& scene, const ReductionTrials& trials,
                                       const linear::SolverOptions& solver,
                                       const ReduceProgress& progress);

/// A table of error, size and time.
report::TextTable comparison_table(const ReductionComparison& found);

/// The JSON members of the summary.
std::vector<report::Json::Member> comparison_json(const ReductionComparison& found);

/// Error against time and against size, a picture in SVG.
std::string comparison_picture(const ReductionComparison& found);

}  // namespace chladni::cases
