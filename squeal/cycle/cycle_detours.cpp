#include "squeal/cycle/cycle_detours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "squeal/cycle/cycle_guess.hpp"
#include "squeal/cycle/hopf_cycle.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// Where the search for the Hopf point begins, relative to the speed.
constexpr double lowest_speed = 0.01;
/// Steps along the branch, as branch_follower.cpp takes them.
constexpr double length_first = 0.05, length_max = 0.3, length_min = 1e-3;
constexpr int steps_max = 200;

constexpr int n_chunks = 30;
constexpr double periods_per_chunk = 100.0;
/// Of the integration of a transient that only leads to a start.
constexpr double rough_tolerance = 1e-7;
/// Samples of two periods among which the return of a state is looked for.
constexpr int n_samples = 400;
/// Distance after one period, relative, from which Newton's method has a chance.
constexpr double comes_back = 0.1;

/// The limit at which stability is lost, the nearest below the speed.
std::optional<StabilityPoint> limit_below(const Brake& brake, double speed)
{
  const StabilityProfile profile = stability_over_speed(
      state_matrix_at(brake), {.from = lowest_speed * speed, .to = speed, .count = 2});
  if (profile.unstable.empty() || profile.unstable.back().from.value == profile.from.value)
    return std::nullopt;
  return profile.unstable.back().from;
}

/// A state of a motion and when it comes nearest to itself again.
struct Return {
  CycleStart start;
  double distance;  ///< relative
};

Return return_of(AutonomousMotion& motion, const Eigen::VectorXd& x, double period)
{
  const Eigen::MatrixXd states =
      states_over_period(motion, {x, 2.0 * period}, n_samples, rough_tolerance);
  const Eigen::VectorXd distance = (states.colwise() - x).colwise().norm() / x.norm();
  constexpr int first = n_samples / 4;
  Eigen::Index i = 0;
  const double nearest = distance.tail(n_samples - first).minCoeff(&i);
  return {{x, 2.0 * period * double(i + first) / n_samples}, nearest};
}

}  // namespace

Detour cycle_by_continuation(const Brake& brake, double speed)
{
  const auto limit = limit_below(brake, speed);
  if (!limit) return {{}, "there is no Hopf point at lower speeds to continue from"};
  const AutonomousMotionAt motion = [&brake](double at) { return brake.motion(at); };
  const std::string from = fmt::format("the Hopf point at {:.6g} rad/s", limit->value);
  auto point = cycle_at_hopf(brake, motion, *limit);
  if (!point) return {{}, "no small cycle was found at " + from};
  double length = length_first;
  for (int i = 0; i < steps_max && length > length_min; ++i) {
    const auto next = next_on_arc(motion, *point, length);
    if (!next) {
      length *= 0.5;
      continue;
    }
    if (point->speed < speed && next->speed >= speed) {
      const double s = (speed - point->speed) / (next->speed - point->speed);
      const CycleStart near{point->at.x + s * (next->at.x - point->at.x),
                            point->at.period + s * (next->at.period - point->at.period)};
      auto cycle = limit_cycle_near(brake, speed, near);
      if (cycle) return {std::move(cycle), "by continuation from " + from};
    }
    point = next;
    length = std::min(1.5 * length, length_max);
  }
  return {{}, fmt::format("the branch from {} was lost at {:.6g} rad/s", from, point->speed)};
}

Detour cycle_by_transient(const Brake& brake, double speed)
{
  const std::unique_ptr<AutonomousMotion> motion = brake.motion(speed);
  const EigenPair pair = least_stable_pair(brake.state_matrix(speed));
  Eigen::VectorXd x = moving_the_pad(*motion, pair.u, brake.rest_compression()).real();
  double period = 2.0 * pi / pair.lambda.imag();
  Return last{{x, period}, 1.0};
  for (int i = 1; i <= n_chunks; ++i) {
    x = end_of(*motion, {x, periods_per_chunk * period}, rough_tolerance);
    if (!x.allFinite()) return {{}, "a transient grew beyond all numbers"};
    last = return_of(*motion, x, period);
    if (last.distance > comes_back) continue;
    period = last.start.period;
    auto cycle = limit_cycle_near(brake, speed, last.start);
    if (cycle)
      return {std::move(cycle),
              fmt::format("after a transient of {:.0f} periods", i * periods_per_chunk)};
  }
  return {
      {},
      fmt::format("after {:.0f} periods a transient still changed by {:.2g} % from one period to "
                  "the next",
                  n_chunks * periods_per_chunk, 100.0 * last.distance)};
}

}  // namespace chladni::squeal
