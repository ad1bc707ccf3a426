#pragma once

#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/transient/recorder.hpp"

namespace chladni::squeal {

/// Largest pad displacement of linear growth, relative to the compression of the pads at rest. The
/// first nonlinear term is quadratic and changes the rate by about 1 % at 1.
inline constexpr double linear_part = 0.05;

/// Lowest and highest angular frequency of a motion, rad/s.
struct FrequencyRange {
  double lowest;
  double highest;
};

/// Limit (m, m/s, N) above which a motion counts as diverged; squares and cubes of it are still
/// finite, and so is all recorded data.
inline constexpr double motion_max = 1e30;

/// Smallest allowed number of steps per period of the highest mode.
inline constexpr int steps_per_period_min = 8;

/// Checks the options of a transient.
/// @throws chladni::Error as `recording_plan`, except for the number of steps.
void check_transient(const TransientCase& run, double omega_highest);

/// Amount of data to record of a transient with these frequencies; it is limited for long runs.
/// @param samples  samples per period of the highest frequency
/// @throws chladni::Error for a speed of zero, a duration or an initial displacement that is not
///         positive, and too few or too many steps.
RecordingPlan recording_plan(const TransientCase& run, const FrequencyRange& omega, int samples);

/// The transient from which a growth rate is measured, far below loss of contact.
/// @param compression  compression of the pads at rest, m
TransientCase growth_case(double speed, double duration, double compression);

/// The growth rate of a transient from growth_case, 1/s.
/// @throws chladni::Error when the transient is too short; `omega_lowest` (rad/s) gives the
///         recommended duration.
double required_growth_rate(const Transient& run, double duration, double omega_lowest);

}  // namespace chladni::squeal
