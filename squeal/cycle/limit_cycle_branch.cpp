#include "squeal/cycle/limit_cycle_branch.hpp"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "squeal/cycle/continuation.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/numerics.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

namespace {

/// Follows parts of a branch of limit cycles along its arc, through folds, until it leaves a range
/// of speeds or ends at rest, and computes the cycles at the speeds of the range.
class BranchFollower {
 public:
  /// @param brake  must outlive this object
  BranchFollower(const Brake& brake, const SpeedRange& range);

  const AutonomousMotionAt& motion() const { return motion_; }

  /// Follows the branch from a cycle, which is not added to the points, towards lower (-1) or
  /// higher (1) speeds.
  LimitCycleBranch from_cycle(const DirectLimitCycle& start, double direction,
                              const Progress& progress) const;

  /// Follows the branch from a point in the direction of its tangent.
  LimitCycleBranch from_point(ArcPoint point, const Progress& progress) const;

  /// The quantities of the cycle at a point of the arc, without solving for it again at a fixed
  /// speed. It is used at folds and near rest, where Newton's method at one speed does not
  /// converge.
  /// @return absent when a contact switches endlessly
  std::optional<BranchPoint> as_it_is(const ArcPoint& point) const;

 private:
  double progress_at(double speed, double direction) const;

  /// Adds the cycles at the speeds of the range between two points of the arc, and the fold if
  /// there is one.
  void add_between(const ArcPoint& a, const ArcPoint& b, double length,
                   LimitCycleBranch& part) const;
  void add_speeds(const ArcPoint& a, const ArcPoint& b, LimitCycleBranch& part) const;
  void add(const CycleStart& near, double speed, std::vector<BranchPoint>& points) const;

  const Brake& brake_;
  AutonomousMotionAt motion_;
  SpeedRange range_;
  Eigen::VectorXd speeds_;
};

/// Lengths of steps along the branch, whose unit is a change of the amplitude by itself.
constexpr double length_first = 0.05, length_max = 0.3, length_min = 1e-4;

constexpr int steps_of_branch_max = 2000;

/// A cycle below this fraction of the largest one of the branch is its end at rest.
constexpr double end_at_rest = 1e-3;

/// Of the place of a fold, relative to the step in which it is.
constexpr double fold_error = 1e-3;

/// The direction of the speed along the branch.
double slope(const ArcPoint& point)
{
  return point.tangent[point.tangent.size() - 1];
}

/// The quantities of a cycle that a branch stores.
BranchPoint point_of_cycle(const DirectLimitCycle& cycle)
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
  for (int i = 0; i < steps_of_branch_max; ++i) {
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
  if (const auto cycle = limit_cycle_near(brake_, speed, near))
    points.push_back(point_of_cycle(*cycle));
}

std::optional<BranchPoint> BranchFollower::as_it_is(const ArcPoint& point) const
{
  const std::unique_ptr<AutonomousMotion> motion = brake_.motion(point.speed);
  const auto orbit = orbit_as_it_is(*motion, point.at);
  if (!orbit) return std::nullopt;
  return point_of_cycle(measured_cycle(brake_, *motion, *orbit, point.speed));
}

/// The highest speed of the range at which the sliding brake is unstable.
std::optional<double> highest_unstable(const Brake& brake, const SpeedRange& range)
{
  const Eigen::VectorXd speeds = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to);
  for (Eigen::Index i = speeds.size() - 1; i >= 0; --i)
    if (least_stable_eigenvalue(brake.state_matrix(speeds[i])).real() > 0.0) return speeds[i];
  return std::nullopt;
}

/// The branch through a cycle, in both directions, from its end on the side of low speeds.
LimitCycleBranch branch_through(const BranchFollower& follower, const DirectLimitCycle& start,
                                const SpeedRange& range, const Progress& progress)
{
  LimitCycleBranch branch = follower.from_cycle(start, -1.0, progress);
  std::ranges::reverse(branch.points);
  std::ranges::reverse(branch.folds);
  branch.points.push_back(point_of_cycle(start));
  if (start.speed < range.to) append(branch, follower.from_cycle(start, 1.0, progress));
  return branch;
}

/// The limit at which the first branch begins.
std::optional<StabilityPoint> limit_of(const StabilityProfile& profile)
{
  const std::optional<StabilityPoint> lost = first_loss(profile);
  return lost ? lost : first_regain(profile);
}

/// The branch from its Hopf point on; the limit of stability says where that is.
LimitCycleBranch branch_from(const BranchFollower& follower, const Brake& brake,
                             const StabilityPoint& limit, const Progress& progress)
{
  const auto start = cycle_at_hopf(brake, follower.motion(), limit);
  if (!start) return {};
  const auto first = follower.as_it_is(*start);
  if (!first) return {};
  LimitCycleBranch branch = follower.from_point(*start, progress);
  branch.origin = BranchOrigin{limit.value, limit.frequency_Hz, *first};
  return branch;
}

bool reaches(const LimitCycleBranch& branch, double speed)
{
  return std::ranges::any_of(branch.points,
                             [speed](const BranchPoint& point) { return point.speed == speed; });
}

/// Why a branch begins, or goes on, with a cycle at a speed.
std::string note_of(const LimitCycleBranch& branch, const std::optional<StabilityPoint>& limit,
                    double speed)
{
  const std::string begins = fmt::format("begins with the limit cycle at {:.6g} rad/s", speed);
  if (!limit)
    return "sliding is unstable at all of the speeds, no Hopf point: the branch " + begins;
  if (!branch.origin) {
    return fmt::format(
        "no small cycle was found at the limit of stability, {:.6g} rad/s: the "
        "branch {}",
        limit->value, begins);
  }
  return fmt::format(
      "the branch from the Hopf point does not reach {0:.6g} rad/s within the "
      "speeds: a second part goes through the limit cycle at {0:.6g} rad/s",
      speed);
}

}  // namespace

LimitCycleBranch limit_cycle_branch(const Brake& brake, const SpeedRange& range,
                                    const Progress& progress)
{
  brake.motion(range.to);  // says why, where there is none
  const BranchFollower follower(brake, range);
  const auto limit = limit_of(stability_until_critical(state_matrix_at(brake), range));
  LimitCycleBranch branch;
  if (limit) branch = branch_from(follower, brake, *limit, progress);
  const std::optional<double> speed = highest_unstable(brake, range);
  if (!speed || reaches(branch, *speed)) return branch;
  try {
    const DirectLimitCycle start = limit_cycle_direct(brake, *speed);
    LimitCycleBranch second = branch_through(follower, start, range, progress);
    const std::string note = note_of(branch, limit, *speed);
    return joined(std::move(branch), std::move(second), note);
  } catch (const Error& error) {
    if (!branch.origin) throw;
    branch.note = fmt::format("the branch from the Hopf point does not reach {:.6g} rad/s; {}",
                              *speed, error.what());
  }
  return branch;
}

namespace {

/// Relative difference below which two cycles at one speed are the same: each is found to 1e-6, and
/// so are its multipliers, which magnify that near 1.
constexpr double same_cycle = 1e-4;

bool is_same(const BranchPoint& a, const BranchPoint& b)
{
  const auto near = [](double x, double y) { return std::abs(x - y) <= same_cycle * std::abs(y); };
  return a.speed == b.speed && near(a.frequency_Hz, b.frequency_Hz) &&
         near(a.pad_velocity, b.pad_velocity) && near(a.pad_displacement, b.pad_displacement);
}

bool share_a_cycle(const LimitCycleBranch& a, const LimitCycleBranch& b)
{
  return std::ranges::any_of(a.points, [&b](const BranchPoint& x) {
    return std::ranges::any_of(b.points, [&x](const BranchPoint& y) { return is_same(x, y); });
  });
}

}  // namespace

void append(LimitCycleBranch& branch, const LimitCycleBranch& part)
{
  branch.points.insert(branch.points.end(), part.points.begin(), part.points.end());
  branch.folds.insert(branch.folds.end(), part.folds.begin(), part.folds.end());
  if (part.lost_below) branch.lost_below = part.lost_below;
  if (part.lost_above) branch.lost_above = part.lost_above;
}

LimitCycleBranch joined(LimitCycleBranch first, LimitCycleBranch second, const std::string& note)
{
  if (first.points.empty() || !share_a_cycle(first, second)) {
    if (!first.points.empty() && !second.points.empty()) first.second_part = first.points.size();
    append(first, second);
    first.note = note;
    return first;
  }
  if (second.points.size() <= first.points.size()) return first;
  const bool ends_small =
      second.points.back().pad_displacement < second.points.front().pad_displacement;
  if (first.origin && ends_small) {  // at its origin
    std::ranges::reverse(second.points);
    std::ranges::reverse(second.folds);
  }
  second.origin = first.origin;
  return second;
}

}  // namespace chladni::squeal
