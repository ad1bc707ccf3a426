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

/// Everything that a study may yield; what was not asked for is absent.
struct SquealResults {
  std::optional<double> wheel_radius;  ///< m, for speeds on the road; absent where none was given
  /// Largest relative difference of the two frequencies of a pair of modes, which eigenvalues are
  /// computed without; absent when the disc is not axisymmetric. 1e-4 of split changes the growth
  /// rate of the reference disc by 1e-4 of it, 1e-3 by 1e-2.
  std::optional<double> largest_split;
  std::optional<EigenvalueMap> eigenvalues;
  bool searched_critical_speed = false;  ///< tells "none in the range" from "not asked for"
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
  /// Why an analysis failed after others had succeeded; nothing was done after it.
  std::optional<std::string> failure;
  /// What was asked for and is not there, by the names of the scene: the run was interrupted, or an
  /// analysis failed.
  std::vector<std::string> missing;
  std::string inputs;  ///< RunOrigin::inputs of an unfinished run; empty otherwise
};

}  // namespace chladni::squeal
