#include "squeal/cycle/limit_cycle_branch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "reference_branches.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

LimitCycleBranch branch_over(ContactLaw law, const SpeedRange& speeds)
{
  SquealOptions options = reference_options(law);
  options.study.speeds = speeds;
  return limit_cycle_branch(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study.speeds);
}

const SpeedRange onset{.from = 4.25 * pi, .to = 5.0 * pi, .count = 31};
const SpeedRange fast{.from = 6.0 * pi, .to = 20.0 * pi, .count = 8};

/// SQUEAL reference values, 1749.75 Hz: shooting with finite differences.
struct ReferencePoint {
  double speed_by_pi, velocity, frequency_Hz;
};

void expect_points(const LimitCycleBranch& branch, const std::vector<ReferencePoint>& references,
                   const ReferencePoint& tolerance)
{
  for (const ReferencePoint& reference : references) {
    bool found = false;
    for (const BranchPoint& point : branch.points) {
      if (std::abs(point.speed / pi - reference.speed_by_pi) > 1e-9) continue;
      found = true;
      EXPECT_NEAR(point.pad_velocity, reference.velocity, tolerance.velocity * reference.velocity)
          << reference.speed_by_pi;
      EXPECT_NEAR(point.frequency_Hz, reference.frequency_Hz, tolerance.frequency_Hz)
          << reference.speed_by_pi;
      EXPECT_LT(point.largest_multiplier, 1.0);
    }
    EXPECT_TRUE(found) << reference.speed_by_pi;
  }
}

TEST(LimitCycleBranch, IsThatOfTheReferenceWithBilateralContact)
{
  // The reference steps over the kinks of |N|, which leaves it up to 8e-5 of the velocity.
  const ReferencePoint tolerance{0.0, 1.5e-4, 1e-4};
  const LimitCycleBranch branch = branch_over(ContactLaw::bilateral, onset);
  EXPECT_FALSE(branch.lost_below);
  expect_points(branch,
                {{4.275, 1.227312, 1772.09693},
                 {4.3, 3.72364, 1772.10984},
                 {4.5, 4.37486, 1772.27184},
                 {5.0, 5.374382, 1772.70162}},
                tolerance);
  expect_points(branch_over(ContactLaw::bilateral, fast),
                {{6.0, 6.946217, 1773.6455},
                 {8.0, 9.501921, 1775.79304},
                 {10.0, 11.669196, 1778.18307},
                 {20.0, 20.085018, 1791.72788}},
                tolerance);
}

TEST(LimitCycleBranch, IsThatOfTheReferenceWithUnilateralContact)
{
  // Where contact is lost, steps over the kinks and finite differences leave the reference 1e-3 of
  // the velocity; the next test has a sharper one.
  const ReferencePoint tolerance{0.0, 1.2e-3, 5e-3};
  expect_points(branch_over(ContactLaw::unilateral, onset),
                {{4.275, 1.227312, 1772.09693},
                 {4.3, 3.738524, 1772.10374},
                 {4.5, 5.825282, 1769.98156},
                 {5.0, 8.489082, 1768.54927}},
                tolerance);
  expect_points(branch_over(ContactLaw::unilateral, fast),
                {{6.0, 12.174917, 1768.34559},
                 {8.0, 17.486761, 1769.99201},
                 {10.0, 21.759116, 1772.34606},
                 {20.0, 40.398247, 1786.21926}},
                tolerance);
}

/// What a row of the reference may be off by: velocity and displacement relative, frequency in Hz,
/// the smallest normal force in N, the multiplier.
struct RowTolerance {
  double amplitude, frequency_Hz, N_min, multiplier;
  std::vector<double> rough_by_pi = {};  ///< speeds at which it is off by up to six times as much
};

/// Every row of the reference, in the ranges that hold their speeds.
void expect_rows(ContactLaw law, const std::vector<BranchRow>& rows, const RowTolerance& tolerance)
{
  const SpeedRange ranges[] = {{4.25 * pi, 5.0 * pi, 31},
                               {4.28 * pi, 4.32 * pi, 5},
                               {5.0 * pi, 7.0 * pi, 5},
                               {6.0 * pi, 20.0 * pi, 8},
                               {10.0 * pi, 20.0 * pi, 3}};
  std::vector<BranchPoint> points;
  for (const SpeedRange& range : ranges)
    std::ranges::copy(branch_over(law, range).points, std::back_inserter(points));
  for (const BranchRow& row : rows) {
    SCOPED_TRACE(row.speed_by_pi);
    const auto at = std::ranges::find_if(points, [&](const BranchPoint& point) {
      return std::abs(point.speed / pi - row.speed_by_pi) < 1e-9;
    });
    ASSERT_NE(at, points.end());
    const bool is_rough = std::ranges::count(tolerance.rough_by_pi, row.speed_by_pi) > 0;
    const double factor = is_rough ? 6.0 : 1.0, relative = factor * tolerance.amplitude;
    EXPECT_NEAR(at->pad_velocity, row.velocity, relative * row.velocity);
    EXPECT_NEAR(at->pad_displacement, row.displacement, relative * row.displacement);
    EXPECT_NEAR(at->frequency_Hz, row.frequency_Hz, factor * tolerance.frequency_Hz);
    EXPECT_NEAR(at->N_min, row.N_min, factor * tolerance.N_min);
    EXPECT_NEAR(at->largest_multiplier, row.multiplier, factor * tolerance.multiplier);
  }
}

TEST(LimitCycleBranch, MeetsEveryRowOfTheReference)
{
  // What steps over the kinks of the contact law leave the reference: largest where contact is
  // lost, and least where the force only changes its sign.
  expect_rows(ContactLaw::bilateral, bilateral_rows, {1e-4, 6e-5, 0.3, 2e-4});
  // Its velocities at 4.4 and 4.6 pi do not lie on a smooth line with their neighbours; ours do.
  expect_rows(ContactLaw::unilateral, unilateral_rows, {1e-3, 6e-3, 0.006, 2.5e-3, {4.4, 4.6}});
  // At 7 pi the slip all but stops, 0.017 m/s, and its direction turns within microseconds.
  expect_rows(ContactLaw::signed_force, signed_rows, {2.1e-5, 4e-5, 0.6, 6e-5, {7.0}});
}

TEST(LimitCycleBranch, HoldsTheEndOfATransient)
{
  // 80 steps per period leave 1e-5 of the velocity to the splitting.
  const LimitCycle end = limit_cycle(
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options(ContactLaw::unilateral)),
                {.speed = 8.0 * pi,
                 .duration = 4.0,
                 .initial_pad_displacement = 1e-3,
                 .steps_per_period = 80}));
  const LimitCycleBranch branch = branch_over(ContactLaw::unilateral, fast);
  ASSERT_EQ(branch.points.size(), 8u);
  EXPECT_NEAR(branch.points[1].pad_velocity, end.pad_velocity, 2e-5 * end.pad_velocity);
  EXPECT_NEAR(branch.points[1].frequency_Hz, end.frequency_Hz, 1e-7 * end.frequency_Hz);
}

TEST(LimitCycleBranch, BeginsAtTheCriticalSpeedWithASquareRoot)
{
  // v^2 = 486 (Omega - Omega_c) / pi (SQUEAL reference value, three digits, near the onset).
  const LimitCycleBranch branch =
      branch_over(ContactLaw::bilateral, {.from = 4.27 * pi, .to = 4.28 * pi, .count = 11});
  ASSERT_EQ(branch.points.size(), 9u);  // two of the speeds are below 4.2719 pi
  const BranchPoint& first = branch.points.front();
  const double v = first.pad_velocity;
  EXPECT_NEAR(v * v / (first.speed / pi - 4.2718984074), 486.0, 5.0);
}

TEST(LimitCycleBranch, BeginsAtTheHopfPointWithASmallCycle)
{
  const LimitCycleBranch branch = branch_over(ContactLaw::bilateral, onset);
  ASSERT_TRUE(branch.origin);
  EXPECT_NEAR(branch.origin->speed / pi, 4.2718984074, 1e-8);
  const BranchPoint& first = branch.origin->first;
  EXPECT_LT(first.pad_displacement, 0.03 * 2000.0 / 6e6);
  EXPECT_GT(first.speed, branch.origin->speed);
  EXPECT_NEAR(first.speed, branch.origin->speed, 1e-4);
  // The same square root as farther on.
  const double v = first.pad_velocity;
  EXPECT_NEAR(v * v / ((first.speed - branch.origin->speed) / pi), 486.0, 5.0);
  EXPECT_NEAR(first.frequency_Hz, branch.origin->frequency_Hz, 1e-3);
  EXPECT_EQ(branch.note, "");
}

TEST(LimitCycleBranch, SaysThatItDoesNotBeginAtAHopfPointWhereThereIsNone)
{
  const LimitCycleBranch branch = branch_over(ContactLaw::unilateral, fast);
  EXPECT_FALSE(branch.origin);
  EXPECT_NE(branch.note.find("unstable at all"), std::string::npos) << branch.note;
  EXPECT_EQ(branch.points.size(), 8u);
}

TEST(LimitCycleBranch, IsTheSameFromAboveAndFromTheEigenvector)
{
  // Both are integrated until the multiplier along the cycle is 1 to 1e-6; the other multipliers
  // near 1 magnify what is left, about 1e-8 per period, by 500.
  const LimitCycleBranch branch = branch_over(ContactLaw::unilateral, fast);
  const DirectLimitCycle cycle = limit_cycle_direct(
      FlexibleDisc(disc_of({kirchhoff_3()}), reference_options(ContactLaw::unilateral)), 6.0 * pi);
  EXPECT_NEAR(branch.points.front().pad_velocity, cycle.pad_velocity, 1e-5 * cycle.pad_velocity);
}

LimitCycleBranch part_of(const std::vector<double>& speeds, double velocity)
{
  LimitCycleBranch part;
  for (const double speed : speeds) part.points.push_back({speed, 1000.0, velocity, 1e-3, 0, 0, 0});
  return part;
}

std::vector<double> speeds_of(const LimitCycleBranch& branch)
{
  std::vector<double> speeds;
  for (const BranchPoint& point : branch.points) speeds.push_back(point.speed);
  return speeds;
}

TEST(LimitCycleBranch, TellsWhereItsSecondPartBegins)
{
  const LimitCycleBranch branch = joined(part_of({1, 2}, 1.0), part_of({2, 3, 4}, 5.0), "two");
  EXPECT_EQ(speeds_of(branch), (std::vector<double>{1, 2, 2, 3, 4}));
  EXPECT_EQ(branch.second_part, 2u);
  EXPECT_EQ(branch.note, "two");
  const LimitCycleBranch alone = joined({}, part_of({2, 3}, 5.0), "one");
  EXPECT_FALSE(alone.second_part);
  EXPECT_EQ(alone.note, "one");
}

TEST(LimitCycleBranch, HasNoSecondPartThatItHasAlready)
{
  // The first part has lost its cycle at 3; that at 4 led to the second.
  LimitCycleBranch first = part_of({1, 2, 4}, 1.0);
  first.origin = BranchOrigin{0.5, 1000.0, first.points.front()};
  const LimitCycleBranch branch = joined(first, part_of({1, 2, 3, 4}, 1.0), "two");
  EXPECT_EQ(speeds_of(branch), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_FALSE(branch.second_part);
  EXPECT_EQ(branch.note, "");
  EXPECT_TRUE(branch.origin);
  // A branch begins with its small cycles, also those that go to lower speeds.
  LimitCycleBranch down = part_of({1, 2, 3, 4}, 1.0);
  first.points.back().pad_displacement = down.points.back().pad_displacement = 1e-6;
  EXPECT_EQ(speeds_of(joined(first, down, "")), (std::vector<double>{4, 3, 2, 1}));
}

TEST(LimitCycleBranch, IsEmptyWhereTheDiscIsStable)
{
  EXPECT_TRUE(
      branch_over(ContactLaw::bilateral, {.from = pi, .to = 4.0 * pi, .count = 5}).points.empty());
}

}  // namespace
}  // namespace chladni::squeal
