#include "squeal/cycle/limit_cycle_branch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "squeal/cycle/branch_arc.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/cycle/measured_cycle.hpp"
#include "squeal/root.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

/// Lengths of steps along the branch, whose unit is a change of the amplitude by itself.
constexpr double length_first = 0.05, length_max = 0.3, length_min = 1e-4;
constexpr int steps_max = 2000;
/// A cycle below this fraction of the largest one of the branch is its end at rest.
constexpr double end_at_rest = 1e-3;
/// Of the place of a fold, relative to the step in which it is.
constexpr double fold_error = 1e-3;
/// Of the integration of a cycle at a fold.
constexpr double orbit_tolerance = 1e-9;

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

/// One part of a branch as it is followed.
class Follower {
 public:
  Follower(const Brake& brake, const SpeedRange& range)
      : brake_(brake),
        motion_([&brake](double speed) { return brake.motion(speed); }),
        range_(range),
        speeds_(Eigen::VectorXd::LinSpaced(range.count, range.from, range.to))
  {}

  /// From a cycle towards lower (-1) or higher (1) speeds.
  LimitCycleBranch follow(const DirectLimitCycle& start, double direction, const Progress& progress)
  {
    LimitCycleBranch part;
    auto point = arc_point(motion_, {start.x, 1.0 / start.frequency_Hz}, start.speed, direction);
    double length = length_first, largest = start.x.norm();
    for (int i = 0; point && i < steps_max; ++i) {
      if (progress) progress(progress_at(point->speed, direction));
      const auto next = next_on_arc(motion_, *point, length);
      if (!next) {
        length *= 0.5;
        if (length > length_min) continue;
        part.lost_below = point->speed;
        break;
      }
      add_between(*point, *next, length, part);
      largest = std::max(largest, next->at.x.norm());
      const bool rest = next->at.x.norm() < end_at_rest * largest;
      if (rest || next->speed < range_.from || next->speed > range_.to) break;
      point = next;
      length = std::min(1.5 * length, length_max);
    }
    return part;
  }

 private:
  double progress_at(double speed, double direction) const
  {
    const double part = (speed - range_.from) / std::max(range_.to - range_.from, 1e-300);
    return std::clamp(direction < 0.0 ? 1.0 - part : part, 0.0, 1.0);
  }

  /// The speeds of the range between two points of the arc, and the fold if there is one.
  void add_between(const ArcPoint& a, const ArcPoint& b, double length, LimitCycleBranch& part)
  {
    const auto slope = [](const ArcPoint& point) {
      return point.tangent[point.tangent.size() - 1];
    };
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
    part.folds.push_back(as_it_is(fold));
    add_speeds(fold, b, part);
  }

  void add_speeds(const ArcPoint& a, const ArcPoint& b, LimitCycleBranch& part)
  {
    std::vector<double> between;
    for (const double speed : speeds_) {
      const bool passed = b.speed < a.speed ? speed < a.speed && speed >= b.speed
                                            : speed > a.speed && speed <= b.speed;
      if (passed) between.push_back(speed);
    }
    if (b.speed < a.speed) std::reverse(between.begin(), between.end());
    for (const double speed : between) {
      const double s = (speed - a.speed) / (b.speed - a.speed);
      add({a.at.x + s * (b.at.x - a.at.x), a.at.period + s * (b.at.period - a.at.period)}, speed,
          part.points);
    }
  }

  void add(const CycleStart& near, double speed, std::vector<BranchPoint>& points) const
  {
    if (const auto cycle = limit_cycle_near(brake_, speed, near))
      points.push_back(point_of(*cycle));
  }

  /// Newton's method at one speed does not converge at a fold.
  BranchPoint as_it_is(const ArcPoint& point) const
  {
    const std::unique_ptr<AutonomousMotion> motion = brake_.motion(point.speed);
    const Flow end = flow(*motion, point.at, orbit_tolerance);
    return point_of(measured_cycle(brake_, *motion, {point.at, end.derivative, 0, orbit_tolerance},
                                   point.speed));
  }

  const Brake& brake_;
  AutonomousMotionAt motion_;
  SpeedRange range_;
  Eigen::VectorXd speeds_;
};

/// The highest speed of the range at which the sliding brake is unstable.
std::optional<double> highest_unstable(const Brake& brake, const SpeedRange& range)
{
  const Eigen::VectorXd speeds = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to);
  for (Eigen::Index i = speeds.size() - 1; i >= 0; --i)
    if (least_stable_eigenvalue(brake.state_matrix(speeds[i])).real() > 0.0) return speeds[i];
  return std::nullopt;
}

}  // namespace

LimitCycleBranch limit_cycle_branch(const Brake& brake, const SpeedRange& range,
                                    const Progress& progress)
{
  brake.motion(range.to);  // says why, where there is none
  const auto speed = highest_unstable(brake, range);
  if (!speed) return {};
  const DirectLimitCycle start = limit_cycle_direct(brake, *speed);
  Follower follower(brake, range);
  LimitCycleBranch branch = follower.follow(start, -1.0, progress);
  std::reverse(branch.points.begin(), branch.points.end());
  std::reverse(branch.folds.begin(), branch.folds.end());
  branch.points.push_back(point_of(start));
  if (*speed < range.to) {
    const LimitCycleBranch above = follower.follow(start, 1.0, progress);
    branch.points.insert(branch.points.end(), above.points.begin(), above.points.end());
    branch.folds.insert(branch.folds.end(), above.folds.begin(), above.folds.end());
    branch.lost_above = above.lost_below;
  }
  return branch;
}

}  // namespace chladni::squeal
