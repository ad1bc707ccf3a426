#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/files/hdf5.hpp"
#include "mbs_export/reduced_system.hpp"
#include "squeal/results/limit_cycle_results.hpp"
#include "squeal/results/sensitivity_results.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/results/transient_results.hpp"

namespace chladni::squeal {

/// Inputs of a run; only a run with the same inputs can continue an interrupted one.
struct RunOrigin {
  mbs_export::Provenance provenance;  ///< provenance of the results
  std::string inputs;                 ///< digests of the input files, and versions of the programs
};

/// All results of a study; results that were not asked for are absent.
struct SquealResults {
  std::optional<double> wheel_radius;  ///< m, for road speeds; absent when none was given
  /// Largest relative frequency difference within a pair of modes, which eigenvalues neglect;
  /// absent when the disc is not axisymmetric. A split of 1e-4 changes the growth rate of the
  /// reference disc by 1e-4 of its value, 1e-3 by 1e-2.
  std::optional<double> largest_split;
  std::optional<EigenvalueMap> eigenvalues;  ///< of the mean matrix if the disc has asymmetry
  std::optional<EigenvalueMap> frozen_eigenvalues;  ///< of such a disc at its worst frozen angle
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

/// Attribute `format` of a result file.
inline constexpr auto results_format = "chladni-squeal";

/// Writes a file `*.squeal.h5`, under a temporary name that is flushed and then renamed.
/// @throws chladni::Error when the file cannot be written.
void write_results(const std::filesystem::path& file, const SquealResults& results,
                   const mbs_export::Provenance& provenance);

/// Reads a file of `write_results`.
/// @throws chladni::Error naming file and dataset, when something is missing, has a wrong size or
///         is not finite.
SquealResults read_results(const std::filesystem::path& path);
SquealResults read_results(const files::Reader& file);

/// The unit of a parameter by its key, such as "N" for a preload.
std::string unit_of(const std::string& parameter);

}  // namespace chladni::squeal
