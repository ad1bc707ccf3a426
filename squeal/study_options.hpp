#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "squeal/parameter_options.hpp"

namespace chladni::squeal {

/// Equally spaced rotation speeds, rad/s.
struct SpeedRange {
  double from;
  double to;
  int count;
  /// m; if given, speeds are also reported as road speeds.
  std::optional<double> wheel_radius = {};
};

/// Integration method of a transient; see integrator_choice.hpp.
enum class IntegratorKind {
  automatic,
  splitting,  ///< exact modal flow, pad forces as kicks; for any disc
  /// Exact flow of the modes with linearised pads, the remaining pad forces as kicks; for
  /// axisymmetric discs.
  exponential,
  dormand_prince,    ///< explicit Runge-Kutta method of order 8 with located contact events
  generalised_alpha  ///< implicit method, for stiff pads
};

/// A point of a speed program.
struct SpeedPoint {
  double time;   ///< s
  double speed;  ///< rad/s
};

/// A point of a preload program.
struct PreloadPoint {
  double time;    ///< s
  double factor;  ///< factor on the preload of all pads
};

/// A transient that starts with a small displacement of the pads, at rest in the inertial frame.
struct TransientCase {
  double speed;                     ///< rad/s
  double duration;                  ///< s
  double initial_pad_displacement;  ///< m
  /// Steps per period of the highest modal frequency; absent: chosen by `growth_error`. For
  /// adaptive methods it bounds the step.
  std::optional<int> steps_per_period = {};
  IntegratorKind integrator = IntegratorKind::automatic;
  double growth_error = 1e-3;  ///< largest error of growth rates by the integration, 1/s
  /// Program of the speed, linear between points, which begin at t = 0 with `speed`; empty:
  /// constant.
  std::vector<SpeedPoint> speed_program = {};
  /// Program of the preload, linear between points, which begin at t = 0; empty: constant.
  std::vector<PreloadPoint> preload_program = {};

  bool is_constant() const { return speed_program.empty() && preload_program.empty(); }
};

/// Growth of the pad velocity in short transients at several speeds.
struct GrowthCase {
  std::vector<double> speeds;  ///< rad/s
  double duration;             ///< s
};

/// Method for the stability of a disc that need not be axisymmetric; see rotation_stability.hpp.
enum class RotationMethod {
  hill,    ///< Hill's method: harmonics of the rotation
  floquet  ///< Floquet's method: integration over one rotation, as reference
};

/// A limit cycle to be found without a transient.
struct DirectCase {
  double speed;  ///< rad/s
};

/// Derivatives of the critical speed, and of the growth rates at one speed, by all parameters.
struct GradientCase {
  /// Speed of the growth rates, rad/s; absent: critical speed only.
  std::optional<double> speed = {};
};

/// Growth rates over the speeds of the study and an equally spaced parameter.
struct MapCase {
  MapParameter parameter;
  double from;  ///< in the unit of the parameter
  double to;
  int count;
};

/// A band of frequencies in the frame of the pads.
struct FrequencyBand {
  double from_Hz;
  double to_Hz;
};

/// Table of all unstable modes over the speed or another parameter, equally spaced.
struct StabilityCase {
  std::optional<MapParameter> over = {};  ///< absent: the speed
  double from;                            ///< rad/s, or in the unit of the parameter
  double to;
  int count;
  double speed = 0.0;                      ///< speed of a table over another parameter, rad/s
  std::optional<FrequencyBand> band = {};  ///< absent: all frequencies
};

/// Search for the critical value of a parameter at one speed.
struct CriticalCase {
  MapParameter parameter;
  double from;  ///< in the unit of the parameter
  double to;
  double speed;  ///< rad/s
};

/// The pad velocity of the transient as a sound file.
struct SoundCase {
  int rate_Hz;  ///< sampling rate
};

/// The analyses of a study and their options, for any kind of brake.
struct StudyOptions {
  SpeedRange speeds;
  std::vector<std::string> analyses;  ///< names from analysis_options.hpp
  std::optional<TransientCase> transient = {};
  std::optional<GrowthCase> growth = {};
  std::optional<DirectCase> limit_cycle_direct = {};
  RotationMethod rotation_method = RotationMethod::hill;
  std::optional<MapCase> map = {};
  std::optional<GradientCase> gradients = {};
  std::vector<CriticalCase> critical = {};
  std::optional<StabilityCase> stability = {};  ///< absent: over `speeds`, all frequencies
  std::optional<SoundCase> sound = {};
};

/// An analysis that a scene can ask for. Its implementation is the row with the same name in
/// study/analysis_steps.hpp.
struct Analysis {
  std::string_view name;
  std::string_view key;        ///< key of [squeal] that the analysis needs; empty: none
  std::string_view otherwise;  ///< key that may replace it; empty: none
  bool needs_body;             ///< needs a flexible disc
};

/// All analyses, in the order in which messages and documents list them.
inline constexpr std::array<Analysis, 16> analyses{{
    {"eigenvalues", "speeds", "", false},
    {"critical-speed", "speeds", "", false},
    {"stability", "speeds", "", false},
    {"growth", "growth", "", false},
    {"transient", "transient", "", false},
    {"limit-cycle", "transient", "", false},
    {"motion-statistics", "transient", "", false},
    {"limit-cycle-direct", "limit_cycle_direct", "transient", false},
    {"limit-cycle-branch", "speeds", "", false},
    {"stability-map", "map", "", false},
    {"critical-values", "critical", "", false},
    {"spectrum", "transient", "", true},
    {"spectrogram", "transient", "", true},
    {"mode-sensitivity", "speeds", "", true},
    {"rotation-stability", "speeds", "", true},
    {"gradients", "speeds", "", false},
}};

/// The analysis with this name; null for an unknown name.
constexpr const Analysis* find_analysis(std::string_view name)
{
  for (const Analysis& analysis : analyses)
    if (analysis.name == name) return &analysis;
  return nullptr;
}

}  // namespace chladni::squeal
