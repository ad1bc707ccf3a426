#pragma once

#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/transient/recorder.hpp"

namespace chladni::squeal {

/// Pad displacement up to which growth is linear, relative to the compression of the pads at rest:
/// the first nonlinear term is quadratic and reaches about 1 % of the rate at 1.
inline constexpr double linear_part = 0.05;

/// The lowest and the highest angular frequency of a motion, rad/s.
struct FrequencyRange {
  double lowest;
  double highest;
};

/// Beyond this a motion counts as diverged (m, m/s, N): its squares and cubes are numbers yet, so
/// that all that is recorded of it is.
inline constexpr double motion_max = 1e30;

/// Fewest steps for one period of the highest mode that may be asked for.
inline constexpr int steps_per_period_min = 8;

/// @throws chladni::Error as `recording_plan`, but for the number of steps.
void check_transient(const TransientCase& run, double omega_highest);

/// What to record of a transient of these frequencies: amounts that a long run does not exceed.
/// @param samples  for one period of the highest
/// @throws chladni::Error for a speed of zero, a duration or an initial displacement that is not
///         positive, and too few or too many steps.
RecordingPlan recording_plan(const TransientCase& run, const FrequencyRange& omega, int samples);

/// The transient from which a growth rate is read, far below contact loss.
/// @param compression  of the pads at rest, m
TransientCase growth_case(double speed, double duration, double compression);

/// The growth rate of that transient.
/// @throws chladni::Error when it is too short for one; `omega_lowest` (rad/s) says how long it
///         should be.
double required_growth_rate(const Transient& run, double duration, double omega_lowest);

}  // namespace chladni::squeal
