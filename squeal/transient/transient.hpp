#pragma once

#include <functional>
#include <optional>
#include <string>

#include "squeal/brake_options.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/wav.hpp"

namespace chladni::squeal {

/// Callback with the fraction done, 0 to 1.
using Progress = std::function<void(double)>;

/// Callbacks and storage for a long transient.
struct Keeping {
  Progress progress = {};
  WavRecording* sound = nullptr;  ///< receives the pad velocity as sound
};

/// The motion after a small displacement of the first pads, at rest in the inertial frame, by the
/// integrator of the scene or the one of integrator_choice.hpp. An axisymmetric disc starts in its
/// first pair of modes with a_cos = a_sin and the crest of the cosine mode under the first pad.
/// Other discs start with the smallest modal displacement that moves the first pad by this amount,
/// at rest in the disc. A brake without a body uses fixed steps of order 8. A diverging motion ends
/// early with the data recorded so far. The memory does not grow with the duration.
/// @throws chladni::Error for a speed of zero, a duration or an initial displacement that is not
///         positive, too few steps for the highest mode, and from `choose_integrator`.
Transient transient(const Brake& brake, const TransientCase& run, const Keeping& keeping = {});

/// A message on a run that did not finish: "the motion diverged after 0.3 s; ...".
std::string divergence_of(const Transient& run);

/// Growth of a small disturbance at `speed` (rad/s) over `duration` (s), far below loss of contact.
/// @throws chladni::Error when the duration is too short for a rate.
Growth growth(const Brake& brake, double speed, double duration);

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

/// Growth rate: slope of the least-squares line through ln(pad velocity) over the second half of
/// the linear phase, which ends when the pad displacement first exceeds `linear_limit` (m). The
/// first half is left out because decaying modes are still present. Absent for fewer than eight
/// points.
/// @return 1/s
std::optional<double> growth_rate(const Envelope& envelope, double linear_limit);

/// The growth rate to report, 1/s: that of the eigenvalue if known, else the measured one. A short
/// transient may show other motions than the least stable one.
double told_rate(const Growth& growth);

/// Whether a growth rate measured in a transient belongs to another motion than the least stable
/// one: it differs from that of the eigenvalue by more than a tenth and by more than 0.01 1/s.
bool disagree(double measured, double of_eigenvalue);

/// A warning about a transient with such a growth rate; empty when the rates agree.
std::string warning_of_growth(double measured, double of_eigenvalue);

}  // namespace chladni::squeal
