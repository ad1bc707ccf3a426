#pragma once

#include <optional>
#include <string>
#include <vector>

#include "squeal/parameter_options.hpp"

namespace chladni::squeal {

/// Rotation speeds, rad/s, equally spaced.
struct SpeedRange {
  double from;
  double to;
  int count;
  std::optional<double> wheel_radius = {};  ///< m; then speeds are told on the road too
};

/// How a transient is integrated; see integrator_choice.hpp.
enum class IntegratorKind {
  automatic,
  splitting,         ///< exact modes, kicks of the pads: any disc
  exponential,       ///< exact modes and linearised pads, kicks of the rest: axisymmetric discs
  dormand_prince,    ///< explicit Runge-Kutta of order 8, contact events located
  generalised_alpha  ///< implicit, for stiff pads
};

/// A point of a speed program.
struct SpeedPoint {
  double time;   ///< s
  double speed;  ///< rad/s
};

/// A point of a program of the preload.
struct PreloadPoint {
  double time;    ///< s
  double factor;  ///< of the preload of all pads
};

/// A transient from a small initial displacement of the pads at rest in the inertial frame.
struct TransientCase {
  double speed;                     ///< rad/s
  double duration;                  ///< s
  double initial_pad_displacement;  ///< m
  /// Of the highest frequency among the modes used; absent: from `growth_error`. With adaptive
  /// steps it bounds the step.
  std::optional<int> steps_per_period = {};
  IntegratorKind integrator = IntegratorKind::automatic;
  double growth_error = 1e-3;  ///< that the integration may add to a growth rate, 1/s
  /// Speeds to follow, linear between points that begin at t = 0 with `speed`; empty: constant.
  std::vector<SpeedPoint> speed_program = {};
  /// Preload to follow, linear between points that begin at t = 0; empty: constant.
  std::vector<PreloadPoint> preload_program = {};

  bool is_constant() const { return speed_program.empty() && preload_program.empty(); }
};

/// Growth of the pad velocity over a short transient at each of several speeds.
struct GrowthCase {
  std::vector<double> speeds;  ///< rad/s
  double duration;             ///< s
};

/// How the stability of a disc of any kind is found; see rotation_stability.hpp.
enum class RotationMethod {
  hill,    ///< by harmonics of the rotation
  floquet  ///< by integration over one rotation, the reference
};

/// A limit cycle that is found without a transient.
struct DirectCase {
  double speed;  ///< rad/s
};

/// Derivatives by the keys of the brake of the growth rates at one speed, beside those of the
/// critical speed.
struct GradientCase {
  std::optional<double> speed = {};  ///< rad/s; absent: of the critical speed alone
};

/// Growth rates over the speeds of the study and over one more parameter, equally spaced.
struct MapCase {
  MapParameter parameter;
  double from;
  double to;
  int count;
};

/// Frequencies in the frame of the pads.
struct FrequencyBand {
  double from_Hz;
  double to_Hz;
};

/// The table of all unstable modes, over the speed or one more parameter, equally spaced.
struct StabilityCase {
  std::optional<MapParameter> over = {};  ///< absent: the speed
  double from;                            ///< rad/s, or in the unit of the parameter
  double to;
  int count;
  double speed = 0.0;                      ///< when it is not over the speed, rad/s
  std::optional<FrequencyBand> band = {};  ///< absent: all frequencies
};

/// A critical value of a parameter at one speed.
struct CriticalCase {
  MapParameter parameter;
  double from;
  double to;
  double speed;  ///< rad/s
};

/// The pad velocity of the transient as sound.
struct SoundCase {
  int rate_Hz;  ///< of the samples
};

/// What is to be found out about a brake, whatever it is made of.
struct StudyOptions {
  SpeedRange speeds;
  std::vector<std::string> analyses;  ///< names of analysis_options.hpp
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

}  // namespace chladni::squeal
