#include "squeal/limit_cycle_branch.hpp"

#include <algorithm>
#include <cmath>

#include "squeal/inertial_frame.hpp"
#include "squeal/limit_cycle_direct.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

/// Halvings of the way to the next speed before the branch counts as lost.
constexpr int halvings_max = 8;

BranchPoint point_of(const DirectLimitCycle& cycle)
{
  return {.speed = cycle.speed,
          .frequency_Hz = cycle.frequency_Hz,
          .pad_velocity = cycle.pad_velocity,
          .pad_displacement = cycle.pad_displacement,
          .N_min = cycle.N_min,
          .N_max = cycle.N_max,
          .largest_multiplier = std::abs(cycle.multipliers[1])};
}

/// From a cycle to the one at `speed`, by steps as large as Newton's method takes them.
std::optional<DirectLimitCycle> follow(const Disc& disc, const SquealOptions& options,
                                       DirectLimitCycle cycle, double speed)
{
  double step = speed - cycle.speed;
  const double least = std::abs(std::ldexp(step, -halvings_max));
  while (cycle.speed != speed) {
    const bool arrives = std::abs(step) >= std::abs(speed - cycle.speed);
    const double next = arrives ? speed : cycle.speed + step;
    auto found = limit_cycle_near(disc, options, next, {cycle.x, 1.0 / cycle.frequency_Hz});
    if (found) {
      cycle = *std::move(found);
    } else if (step *= 0.5; std::abs(step) < least) {
      return std::nullopt;
    }
  }
  return cycle;
}

}  // namespace

LimitCycleBranch limit_cycle_branch(const Disc& disc, const SquealOptions& options,
                                    const Progress& progress)
{
  const InertialDisc inertial = inertial_disc(disc);
  const SpeedRange& range = options.speeds;
  LimitCycleBranch branch;
  std::optional<DirectLimitCycle> cycle;
  for (int i = range.count - 1; i >= 0; --i) {
    if (progress) progress(1.0 - (i + 1.0) / range.count);
    const double part = range.count > 1 ? double(i) / (range.count - 1) : 1.0;
    const double speed = range.from + part * (range.to - range.from);
    if (!(least_stable_eigenvalue(inertial, options, speed).real() > 0.0)) break;
    cycle = cycle ? follow(disc, options, *cycle, speed) : limit_cycle_direct(disc, options, speed);
    if (!cycle) {
      branch.lost_below = branch.points.back().speed;
      break;
    }
    branch.points.push_back(point_of(*cycle));
  }
  std::reverse(branch.points.begin(), branch.points.end());
  return branch;
}

}  // namespace chladni::squeal
