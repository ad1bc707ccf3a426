#include "squeal/cycle/limit_cycle_branch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "squeal/cycle/branch_follower.hpp"
#include "squeal/cycle/branch_parts.hpp"
#include "squeal/cycle/hopf_cycle.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/stability/stability.hpp"

namespace chladni::squeal {
namespace {

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
  branch.points.push_back(point_of(start));
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

}  // namespace chladni::squeal
