#include "squeal/cycle/periodic_orbit.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "planar_motions.hpp"
#include "squeal/cycle/harmonic_balance.hpp"
#include "squeal/cycle/limit_cycle_branch.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// x_1' = -side, x_2' = 1, with the side of x_1: from x_1 = 0 no motion leads on.
class Chatter final : public AutonomousMotion {
 public:
  Eigen::Index size() const override { return 2; }
  double omega_highest() const override { return 1.0; }
  const Eigen::VectorXd& rate(double /*t*/, const Eigen::VectorXd& x) override
  {
    S_ = x.head(1);
    f_ = Eigen::Vector2d(-side_, 1.0);
    return f_;
  }
  const Eigen::VectorXd& switches() const override { return S_; }
  double side(Eigen::Index /*i*/) const override { return side_; }
  void set_side(Eigen::Index /*i*/, double side) override { side_ = side; }
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& /*x*/) override
  {
    return Eigen::Matrix2d::Zero();
  }
  ContactResult<double> first_contact(const Eigen::VectorXd& /*x*/) override { return {}; }

 private:
  double side_ = 1.0;
  Eigen::VectorXd f_, S_ = Eigen::VectorXd::Zero(1);
};

TEST(PeriodicOrbit, IsAbsentWhereAContactChangesItsSideWithoutEnd)
{
  Chatter motion;
  const CycleStart start{Eigen::Vector2d(0.5, 0.0), 2.0};
  EXPECT_TRUE(end_of(motion, {start.x, 0.4}, 1e-9).allFinite());
  EXPECT_FALSE(end_of(motion, start, 1e-9).allFinite());
  EXPECT_FALSE(flow(motion, start, 1e-9).end.allFinite());
  EXPECT_FALSE(states_over_period(motion, start, 4, 1e-9).allFinite());
  EXPECT_FALSE(periodic_orbit(motion, start));
}

TEST(HarmonicBalance, FindsThePeriodOfVanDerPol)
{
  // The harmonics of the cycle fall by 0.3 from one odd one to the next; 15 leave 1e-5 of the
  // period, and as they double the error falls to rounding of the published value.
  PlanarMotion motion(VanDerPol{});
  HarmonicCycle start{Eigen::MatrixXd::Zero(2, 3), 1.0};
  start.X(0, 1) = 2.0;
  start.X(1, 2) = -2.0;
  double before = 1.0;
  for (const int n : {5, 10, 20, 40}) {
    const auto cycle = harmonic_balance(
        motion, start, {.n_harmonics = n, .n_samples = 4 * n + 8, .tolerance = 1e-11});
    ASSERT_TRUE(cycle);
    const double error = std::abs(2.0 * pi / cycle->omega - van_der_pol_period);
    EXPECT_LT(error, std::max(0.1 * before, 1e-10)) << n;
    before = error;
  }
}

TEST(HarmonicBalance, LeavesNoResidualAtItsSamples)
{
  // With as many harmonics as samples can tell apart, omega X' = f(X) at the samples themselves.
  PlanarMotion motion(VanDerPol{});
  HarmonicCycle start{Eigen::MatrixXd::Zero(2, 3), 1.0};
  start.X(0, 1) = 2.0;
  start.X(1, 2) = -2.0;
  const HarmonicResolution resolution{.n_harmonics = 20, .n_samples = 41, .tolerance = 1e-11};
  const auto cycle = harmonic_balance(motion, start, resolution);
  ASSERT_TRUE(cycle);
  for (int j = 0; j < resolution.n_samples; ++j) {
    const double tau = 2.0 * pi * j / resolution.n_samples;
    Eigen::Vector2d x = cycle->X.col(0), x_dot = Eigen::Vector2d::Zero();
    for (int k = 1; k <= resolution.n_harmonics; ++k) {
      x += cycle->X.col(2 * k - 1) * std::cos(k * tau) + cycle->X.col(2 * k) * std::sin(k * tau);
      x_dot +=
          k * cycle->omega *
          (cycle->X.col(2 * k) * std::cos(k * tau) - cycle->X.col(2 * k - 1) * std::sin(k * tau));
    }
    EXPECT_LT((x_dot - motion.rate_at(x)).norm(), 1e-9);
  }
}

TEST(PeriodicOrbit, IsThatOfVanDerPolWithTheMultipliersOfLiouville)
{
  PlanarMotion motion(VanDerPol{});
  const auto orbit = periodic_orbit(motion, {Eigen::Vector2d{2.0, 0.1}, 6.5});
  ASSERT_TRUE(orbit);
  EXPECT_NEAR(orbit->at.period, van_der_pol_period, 1e-8);  // of the integration
  // det of the monodromy matrix = exp of the integral of the divergence 1 - x^2 over a period.
  const int n = 2000;
  const Eigen::MatrixXd x = states_over_period(motion, orbit->at, n, 1e-11);
  const double divergence = (1.0 - x.row(0).array().square()).mean() * orbit->at.period;
  const Eigen::VectorXcd multipliers = orbit->multipliers.values;
  EXPECT_NEAR(multipliers[0].real(), 1.0, 1e-6);
  EXPECT_NEAR(multipliers[1].real(), std::exp(divergence), 1e-6);
}

TEST(PeriodicOrbit, HasTheDerivativeOfItsFlow)
{
  // Central differences of an integration to 1e-12, with contact loss within the period.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  const auto motion =
      FlexibleDisc(disc, reference_options(ContactLaw::unilateral)).motion(6.0 * pi);
  const CycleStart start{Eigen::VectorXd::LinSpaced(8, 6.0, -5.0), 1.0 / 1750.0};
  const Eigen::MatrixXd derivative = flow(*motion, start, 1e-11).derivative;
  Eigen::MatrixXd differences(8, 8);
  for (int j = 0; j < 8; ++j) {
    const Eigen::VectorXd h = 1e-4 * Eigen::VectorXd::Unit(8, j);
    differences.col(j) = (end_of(*motion, {start.x + h, start.period}, 1e-13) -
                          end_of(*motion, {start.x - h, start.period}, 1e-13)) /
                         2e-4;
  }
  EXPECT_LT((derivative - differences).norm(), 1e-6 * derivative.norm());
}

/// The subcritical Hopf bifurcation as something that squeals.
class SubcriticalBrake final : public Brake {
 public:
  Eigen::MatrixXd state_matrix(double speed) const override
  {
    return SubcriticalHopf{speed}.jacobian(Eigen::Vector2d::Zero());
  }
  /// It has none of these parameters.
  std::unique_ptr<Brake> with(MapParameter /*parameter*/, double /*value*/) const override
  {
    return std::make_unique<SubcriticalBrake>();
  }
  std::unique_ptr<AutonomousMotion> motion(double speed) const override
  {
    return std::make_unique<PlanarMotion<SubcriticalHopf>>(SubcriticalHopf{speed});
  }
  double rest_compression() const override { return 1.0; }
};

TEST(LimitCycleBranch, GoesThroughAFoldToItsUnstablePart)
{
  const LimitCycleBranch branch =
      limit_cycle_branch(SubcriticalBrake(), {.from = 1.0, .to = 3.0, .count = 40});
  ASSERT_EQ(branch.folds.size(), 1u);
  EXPECT_NEAR(branch.folds[0].speed, 1.75, 1e-6);
  EXPECT_NEAR(branch.folds[0].pad_displacement, std::sqrt(0.5), 1e-3);  // quadratic there
  EXPECT_FALSE(branch.lost_below);
  int n_unstable = 0, n_stable = 0;
  for (const BranchPoint& point : branch.points) {
    const double root = std::sqrt(0.25 + point.speed - 2.0);
    const bool lower = point.pad_displacement < std::sqrt(0.5);
    const double s = lower ? 0.5 - root : 0.5 + root;
    EXPECT_NEAR(point.pad_displacement, std::sqrt(s), 1e-6);
    const double multiplier = std::exp(2.0 * pi * (2.0 * s - 4.0 * s * s));
    EXPECT_NEAR(point.largest_multiplier, multiplier, 1e-6 * std::max(1.0, multiplier));
    EXPECT_EQ(point.largest_multiplier > 1.0, lower);
    ++(lower ? n_unstable : n_stable);
  }
  // Of the speeds 1 + 2 i / 39 there are 5 between the fold and 2, and 25 from the fold to 3.
  EXPECT_EQ(n_unstable, 5);
  EXPECT_EQ(n_stable, 25);
}

TEST(LimitCycleBranch, GoesBackFromASubcriticalHopfPoint)
{
  const LimitCycleBranch branch =
      limit_cycle_branch(SubcriticalBrake(), {.from = 1.0, .to = 3.0, .count = 40});
  ASSERT_TRUE(branch.origin);
  EXPECT_NEAR(branch.origin->speed, 2.0, 1e-9);
  EXPECT_NEAR(branch.origin->frequency_Hz, 0.5 / pi, 1e-9);
  const BranchPoint& first = branch.origin->first;
  const double s = first.pad_displacement * first.pad_displacement;
  EXPECT_LT(s, 1e-2);
  EXPECT_NEAR(2.0 - first.speed, s - s * s, 1e-2 * s);
  EXPECT_GT(first.largest_multiplier, 1.0);
  // Backwards first, then forward.
  ASSERT_GE(branch.points.size(), 6u);
  EXPECT_GT(branch.points[0].speed, branch.points[1].speed);
  EXPECT_LT(branch.points[5].speed, branch.points[6].speed);
}

TEST(LimitCycleBranch, FindsTheLargeCyclesThatTheBranchReachesOutsideOfTheSpeeds)
{
  // The fold at 1.75 is below the lowest of the speeds, so that the branch leaves them.
  const LimitCycleBranch branch =
      limit_cycle_branch(SubcriticalBrake(), {.from = 1.9, .to = 3.0, .count = 12});
  ASSERT_TRUE(branch.origin);
  int n_stable = 0;
  for (const BranchPoint& point : branch.points) n_stable += point.largest_multiplier < 1.0;
  EXPECT_EQ(n_stable, 12);
}

}  // namespace
}  // namespace chladni::squeal
