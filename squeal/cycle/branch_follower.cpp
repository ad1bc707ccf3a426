#include "squeal/cycle/branch_follower.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/cycle/measured_cycle.hpp"
#include "squeal/root.hpp"

namespace chladni::squeal {
namespace {

/// Lengths of steps along the branch, whose unit is a change of the amplitude by itself.
constexpr double length_first = 0.05, length_max = 0.3, length_min = 1e-4;
constexpr int steps_max = 2000;
/// A cycle below this fraction of the largest one of the branch is its end at rest.
constexpr double end_at_rest = 1e-3;
/// Of the place of a fold, relative to the step in which it is.
constexpr double fold_error = 1e-3;

/// The direction of the speed along the branch.
double slope(const ArcPoint& point)
{
  return point.tangent[point.tangent.size() - 1];
}

}  // namespace

BranchPoint point_of(const DirectLimitCycle& cycle)
{
  return {.speed = cycle.speed,
          .frequency_Hz = cycle.frequency_Hz,
          .pad_velocity = cycle.pad_velocity,
          .pad_displacement = cycle.pad_displacement,
          .N_min = cycle.N_min,
          .N_max = cycle.N_max,
          .largest_multiplier = std::abs(cycle.multipliers[1]),
          .multiplier_error = cycle.multiplier_error};
}

BranchFollower::BranchFollower(const Brake& brake, const SpeedRange& range)
    : brake_(brake),
      motion_([&brake](double speed) { return brake.motion(speed); }),
      range_(range),
      speeds_(Eigen::VectorXd::LinSpaced(range.count, range.from, range.to))
{}

LimitCycleBranch BranchFollower::from_cycle(const DirectLimitCycle& start, double direction,
                                            const Progress& progress) const
{
  const auto point =
      arc_point(motion_, {start.x, 1.0 / start.frequency_Hz}, start.speed, direction);
  return point ? from_point(*point, progress) : LimitCycleBranch{};
}

LimitCycleBranch BranchFollower::from_point(ArcPoint point, const Progress& progress) const
{
  LimitCycleBranch part;
  const double direction = slope(point);
  double length = length_first, largest = point.at.x.norm();
  for (int i = 0; i < steps_max; ++i) {
    if (progress) progress(progress_at(point.speed, direction));
    const auto next = next_on_arc(motion_, point, length);
    if (!next) {
      length *= 0.5;
      if (length > length_min) continue;
      (slope(point) < 0.0 ? part.lost_below : part.lost_above) = point.speed;
      break;
    }
    add_between(point, *next, length, part);
    largest = std::max(largest, next->at.x.norm());
    const bool rest = next->at.x.norm() < end_at_rest * largest;
    if (rest || next->speed < range_.from || next->speed > range_.to) break;
    point = *next;
    length = std::min(1.5 * length, length_max);
  }
  return part;
}

double BranchFollower::progress_at(double speed, double direction) const
{
  const double part = (speed - range_.from) / std::max(range_.to - range_.from, 1e-300);
  return std::clamp(direction < 0.0 ? 1.0 - part : part, 0.0, 1.0);
}

void BranchFollower::add_between(const ArcPoint& a, const ArcPoint& b, double length,
                                 LimitCycleBranch& part) const
{
  if (slope(a) * slope(b) >= 0.0) return add_speeds(a, b, part);
  ArcPoint fold = a;
  const double sign = slope(a) < 0.0 ? 1.0 : -1.0;
  const auto turned = [&](double s) {
    if (s <= 0.0) return sign * slope(a);
    if (s >= length) return sign * slope(b);
    if (const auto at = next_on_arc(motion_, a, s)) fold = *at;
    return sign * slope(fold);
  };
  root(turned, 0.0, length, fold_error);
  add_speeds(a, fold, part);
  if (const auto cycle = as_it_is(fold)) part.folds.push_back(*cycle);
  add_speeds(fold, b, part);
}

void BranchFollower::add_speeds(const ArcPoint& a, const ArcPoint& b, LimitCycleBranch& part) const
{
  std::vector<double> between;
  for (const double speed : speeds_) {
    const bool passed = b.speed < a.speed ? speed < a.speed && speed >= b.speed
                                          : speed > a.speed && speed <= b.speed;
    if (passed) between.push_back(speed);
  }
  if (b.speed < a.speed) std::ranges::reverse(between);
  for (const double speed : between) {
    const double s = (speed - a.speed) / (b.speed - a.speed);
    add({a.at.x + s * (b.at.x - a.at.x), a.at.period + s * (b.at.period - a.at.period)}, speed,
        part.points);
  }
}

void BranchFollower::add(const CycleStart& near, double speed,
                         std::vector<BranchPoint>& points) const
{
  if (const auto cycle = limit_cycle_near(brake_, speed, near)) points.push_back(point_of(*cycle));
}

std::optional<BranchPoint> BranchFollower::as_it_is(const ArcPoint& point) const
{
  const std::unique_ptr<AutonomousMotion> motion = brake_.motion(point.speed);
  const auto orbit = orbit_as_it_is(*motion, point.at);
  if (!orbit) return std::nullopt;
  return point_of(measured_cycle(brake_, *motion, *orbit, point.speed));
}

}  // namespace chladni::squeal
