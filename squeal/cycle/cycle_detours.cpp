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
constexpr int steps_max = 60;
/// Where the branch is left, relative to the speed, and to the small cycle with which it begins.
constexpr double highest_speed = 2.0, at_rest = 0.05;

constexpr int n_chunks = 30;
constexpr double periods_per_chunk = 100.0;
/// Of the integration of a transient that only leads to a start.
constexpr double rough_tolerance = 1e-7;
/// Samples of three periods among which the return of a state is looked for.
constexpr int n_samples = 600;
constexpr double periods_looked_at = 3.0;
/// A return this much farther off than the nearest one counts too: the first of them is one period.
constexpr double as_near = 2.0;
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

/// A state of a motion and when it comes near to itself again.
struct Return {
  CycleStart start;
  double distance;  ///< relative
};

/// The first of the minima that are about as deep as the deepest, but for what samples resolve;
/// after the state has gone away.
Eigen::Index first_return(const Eigen::VectorXd& distance)
{
  const Eigen::Index n = distance.size();
  Eigen::Index away = 1;
  while (away + 1 < n && distance[away + 1] >= distance[away]) ++away;
  const double resolved = (distance.tail(n - 1) - distance.head(n - 1)).cwiseAbs().maxCoeff();
  const double near = as_near * distance.tail(n - away).minCoeff() + resolved;
  Eigen::Index i = away;
  while (i + 1 < n && !(distance[i] <= near && distance[i + 1] >= distance[i])) ++i;
  return i;
}

/// @param period  of the eigenvector: that of the motion is between a third and three times it
Return return_of(AutonomousMotion& motion, const Eigen::VectorXd& x, double period)
{
  const double span = periods_looked_at * period;
  const Eigen::MatrixXd states = states_over_period(motion, {x, span}, n_samples, rough_tolerance);
  const Eigen::VectorXd distance = (states.colwise() - x).colwise().norm() / x.norm();
  const Eigen::Index i = first_return(distance);
  return {{x, span * double(i) / n_samples}, distance[i]};
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
  const double smallest = at_rest * point->at.x.norm();
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
    if (point->at.x.norm() < smallest) {
      return {{},
              fmt::format("the branch from {} ends at rest at {:.6g} rad/s", from, point->speed)};
    }
    if (point->speed < lowest_speed * speed || point->speed > highest_speed * speed)
      return {{}, fmt::format("the branch from {} leads to {:.6g} rad/s", from, point->speed)};
  }
  return {{},
          fmt::format("the branch from {} was followed to {:.6g} rad/s only", from, point->speed)};
}

Detour cycle_by_transient(const Brake& brake, double speed)
{
  const std::unique_ptr<AutonomousMotion> motion = brake.motion(speed);
  const EigenPair pair = least_stable_pair(brake.state_matrix(speed));
  Eigen::VectorXd x = moving_the_pad(*motion, pair.u, brake.rest_compression()).real();
  const double period = 2.0 * pi / pair.lambda.imag();
  Return last{{x, period}, 1.0};
  for (int i = 1; i <= n_chunks; ++i) {
    x = end_of(*motion, {x, periods_per_chunk * period}, rough_tolerance);
    if (!x.allFinite()) return {{}, "a transient diverged or a contact switched endlessly"};
    last = return_of(*motion, x, period);
    if (!(last.distance <= comes_back)) continue;
    auto cycle = limit_cycle_near(brake, speed, last.start);
    if (cycle) {
      return {std::move(cycle),
              fmt::format("after a transient of {:.0f} periods", i * periods_per_chunk)};
    }
  }
  return {
      {},
      fmt::format("after {:.0f} periods a transient still changed by {:.2g} % from one period to "
                  "the next",
                  n_chunks * periods_per_chunk, 100.0 * last.distance)};
}

}  // namespace chladni::squeal
