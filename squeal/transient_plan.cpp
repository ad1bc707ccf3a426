#include "squeal/transient_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

constexpr int steps_per_period_min = 8;
constexpr double steps_max = 1e10;
/// Periods of the lowest mode for one point of the envelope, and in the tail.
constexpr int periods_per_window = 4;
constexpr int periods_in_tail = 100;
constexpr std::int64_t history_points = 20000;
/// Initial displacement for a growth rate, relative to the compression of the pads at rest.
constexpr double growth_start = 1e-4;

void check(const TransientCase& run, double omega_highest)
{
  if (!(run.speed > 0.0))
    throw Error(
        fmt::format("transient: speed_rad_s = {}; it must be > 0, since friction at rest has "
                    "no direction",
                    run.speed));
  if (!(run.duration > 0.0))
    throw Error(fmt::format("transient: duration_s = {}; it must be > 0", run.duration));
  if (!(run.initial_pad_displacement > 0.0))
    throw Error(fmt::format("transient: initial_pad_displacement = {}; it must be > 0",
                            run.initial_pad_displacement));
  if (run.steps_per_period < steps_per_period_min)
    throw Error(
        fmt::format("transient: {} steps per period do not resolve the highest mode "
                    "({:.0f} Hz); take at least {}, better 40",
                    run.steps_per_period, omega_highest / (2.0 * pi), steps_per_period_min));
}

}  // namespace

RecordingPlan recording_plan(const TransientCase& run, const FrequencyRange& omega)
{
  check(run, omega.highest);
  const double step = 2.0 * pi / (omega.highest * run.steps_per_period);
  const double n_steps = std::ceil(run.duration / step);
  if (!(n_steps < steps_max))
    throw Error(fmt::format("transient: {} s take {:.1e} steps (allowed: {:.0e})", run.duration,
                            n_steps, steps_max));
  const double steps_of_period = 2.0 * pi / (omega.lowest * step);
  const auto n = static_cast<std::int64_t>(n_steps);
  const auto tail = static_cast<std::int64_t>(periods_in_tail * steps_of_period);
  return {.step = step,
          .n_steps = n,
          .window = static_cast<std::int64_t>(periods_per_window * steps_of_period),
          .every = std::max<std::int64_t>(1, n / history_points),
          .n_tail = std::min(n, tail)};
}

TransientCase growth_case(double speed, double duration, double compression)
{
  return {
      .speed = speed, .duration = duration, .initial_pad_displacement = growth_start * compression};
}

double required_growth_rate(const Transient& run, double duration, double omega_lowest)
{
  if (run.growth_rate) return *run.growth_rate;
  throw Error(
      fmt::format("growth: {} s at {} rad/s are too short for a growth rate; simulate at "
                  "least {:.2g} s",
                  duration, run.speed, 200.0 * pi / omega_lowest));
}

}  // namespace chladni::squeal
