#include "squeal/transient/transient_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "common/told_apart.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

constexpr double steps_max = 1e10;
/// What no brake vibrates with, and the steps that still take little time then.
constexpr double absurd_Hz = 1e7, bearable_steps = 1e7;
/// Periods of the lowest mode for one point of the envelope, and in the tail.
constexpr int periods_per_window = 4;
constexpr int periods_in_tail = 100;
/// Most samples of the history: 10 MB. 6 s of them hold what is below 12 kHz.
constexpr std::int64_t history_max = 200000;
constexpr std::int64_t snapshots_max = 20000;
/// Most points of the envelope, the first half of them of a few periods: a growth rate is read
/// there.
constexpr std::int64_t windows_max = 20000;
/// Most samples of the tail: 12 MB, and 2.4 MB for each mode.
constexpr std::int64_t tail_max = 300000;
/// Initial displacement for a growth rate, relative to the compression of the pads at rest.
constexpr double growth_start = 1e-4;

/// Steps of each of at most `n_parts` parts.
std::int64_t parts_of(std::int64_t n_steps, std::int64_t n_parts)
{
  return (n_steps - 1) / n_parts + 1;
}

/// Numbers of other units make bodies so stiff or light that their transients hardly end.
void check_steps(const TransientCase& run, double n_steps, double omega_highest)
{
  const double highest_Hz = omega_highest / (2.0 * pi);
  const bool is_absurd = highest_Hz > absurd_Hz;
  if (n_steps < (is_absurd ? bearable_steps : steps_max)) return;
  constexpr double steps_per_hour = 3.6e9;  // of two modes on one core
  const auto [steps, allowed] = told_apart(n_steps, is_absurd ? bearable_steps : steps_max);
  throw Error(
      fmt::format("transient: {} s take {} steps (allowed: {}), hours: {:.1g} or more, "
                  "since the highest mode has {:.2g} Hz; {}",
                  run.duration, steps, allowed, n_steps / steps_per_hour, highest_Hz,
                  is_absurd ? "no brake has: is the density in kg/m^3 and Young's modulus in Pa?"
                            : "simulate less, or keep fewer modes"));
}

}  // namespace

void check_transient(const TransientCase& run, double omega_highest)
{
  if (!(run.speed > 0.0)) {
    throw Error(
        fmt::format("transient: speed_rad_s = {}; it must be > 0, since friction at rest has "
                    "no direction",
                    run.speed));
  }
  if (!(run.duration > 0.0))
    throw Error(fmt::format("transient: duration_s = {}; it must be > 0", run.duration));
  if (!(run.initial_pad_displacement > 0.0)) {
    throw Error(fmt::format("transient: initial_pad_displacement = {}; it must be > 0",
                            run.initial_pad_displacement));
  }
  if (run.steps_per_period && *run.steps_per_period < steps_per_period_min) {
    throw Error(fmt::format(
        "transient: {} steps per period do not resolve the highest mode ({:.0f} Hz); take at least "
        "{}, better leave steps_per_period out",
        *run.steps_per_period, omega_highest / (2.0 * pi), steps_per_period_min));
  }
}

RecordingPlan recording_plan(const TransientCase& run, const FrequencyRange& omega, int samples)
{
  check_transient(run, omega.highest);
  const double step = 2.0 * pi / (omega.highest * samples);
  const double n_steps = std::ceil(run.duration / step);
  check_steps(run, n_steps, omega.highest);
  const double steps_of_period = 2.0 * pi / (omega.lowest * step);
  const auto n = static_cast<std::int64_t>(n_steps);
  const auto tail = static_cast<std::int64_t>(periods_in_tail * steps_of_period);
  const auto window = static_cast<std::int64_t>(periods_per_window * steps_of_period);
  const std::int64_t n_fine = windows_max / 2;
  const std::int64_t n_behind = std::max<std::int64_t>(1, n - n_fine * window);
  return {.step = step,
          .n_steps = n,
          .window = window,
          .n_fine_windows = n_fine,
          .late_window = std::max(window, parts_of(n_behind, windows_max - n_fine)),
          .history = decimation_to(n, history_max),
          .snapshots = parts_of(n, snapshots_max),
          .n_tail = std::min({n, tail, tail_max})};
}

TransientCase growth_case(double speed, double duration, double compression)
{
  return {
      .speed = speed, .duration = duration, .initial_pad_displacement = growth_start * compression};
}

double required_growth_rate(const Transient& run, double duration, double omega_lowest)
{
  if (run.growth_rate) return *run.growth_rate;
  const double least = 200.0 * pi / omega_lowest;
  if (duration >= least) {
    throw Error(
        fmt::format("growth: at {} rad/s the motion is small for too short a time to measure a "
                    "growth rate; use the analysis \"eigenvalues\"",
                    run.speed));
  }
  throw Error(
      fmt::format("growth: {} s at {} rad/s are too short for a growth rate; simulate at "
                  "least {:.2g} s",
                  duration, run.speed, least));
}

}  // namespace chladni::squeal
