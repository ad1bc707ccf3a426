#pragma once

#include <optional>
#include <string>
#include <vector>

#include "squeal/results/cycle_results.hpp"
#include "squeal/results/gradient_results.hpp"
#include "squeal/results/signal_results.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/results/stability_table.hpp"
#include "squeal/results/transient_results.hpp"

namespace chladni::squeal {

/// All results of a study; results that were not asked for are absent.
struct SquealResults {
  std::optional<double> wheel_radius;  ///< m, for road speeds; absent when none was given
  /// Largest relative frequency difference within a pair of modes, which eigenvalues neglect;
  /// absent when the disc is not axisymmetric. A split of 1e-4 changes the growth rate of the
  /// reference disc by 1e-4 of its value, 1e-3 by 1e-2.
  std::optional<double> largest_split;
  std::optional<EigenvalueMap> eigenvalues;
  bool searched_critical_speed = false;  ///< distinguishes "none in the range" from "not asked for"
  std::optional<CriticalSpeed> critical_speed;
  std::optional<StabilityProfile> speed_stability;  ///< over the speeds of that search
  std::vector<CriticalValue> critical_values;
  std::optional<StabilityTable> stability_table;
  std::optional<StabilityMap> map;
  std::optional<RotationStability> rotation_stability;
  std::optional<ModeSensitivity> mode_sensitivity;
  std::optional<Gradients> gradients;
  std::vector<Growth> growth;
  std::optional<Transient> transient;
  std::optional<LimitCycle> limit_cycle;
  std::optional<DirectLimitCycle> limit_cycle_direct;
  std::optional<LimitCycleBranch> limit_cycle_branch;
  std::optional<Spectrum> spectrum;
  std::optional<Spectrogram> spectrogram;
  std::optional<MotionStatistics> motion_statistics;
  /// Why an analysis failed after others had succeeded; it was the last one performed.
  std::optional<std::string> failure;
  /// Analyses that were asked for and have no result, by their names in the scene, because the run
  /// was interrupted or an analysis failed.
  std::vector<std::string> missing;
  std::string inputs;  ///< RunOrigin::inputs of an unfinished run, else empty
};

}  // namespace chladni::squeal
