#include "squeal/stability/stability_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <utility>
#include <vector>

#include "squeal/stability/eigenvalues.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/motions_side_by_side.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

double growth_of_matrix(const StateMatrixOf& A, double value)
{
  return least_stable_eigenvalue(A(value)).real();
}

TEST(StabilitySearch, TellsEveryIntervalAndTheFirstLoss)
{
  const StateMatrixOf A =
      side_by_side({{[](double v) { return (v - 1.0) * (v - 2.0) * (v - 3.0); }, 5000.0},
                    {[](double) { return -40.0; }, 800.0}});
  const StabilityProfile all = stability_over(A, {.from = 0.1, .to = 4.0, .count = 128});
  ASSERT_EQ(all.unstable.size(), 2u);
  EXPECT_NEAR(all.unstable[0].from.value, 1.0, 1e-9);
  EXPECT_NEAR(all.unstable[0].to.value, 2.0, 1e-9);
  EXPECT_NEAR(all.unstable[1].from.value, 3.0, 1e-9);
  EXPECT_EQ(all.unstable[1].to.value, 4.0);
  EXPECT_NEAR(all.unstable[1].to.growth, 6.0, 1e-9);
  EXPECT_NEAR(all.unstable[0].worst.growth, 0.3849, 1e-3);  // 2 / 27^(1/2), between two samples
  EXPECT_EQ(all.unstable[0].to.growth, 0.0);
  EXPECT_NEAR(all.unstable[0].to.frequency_Hz, 5000.0 / (2.0 * pi), 1e-6);
  EXPECT_EQ(stability_of(all), Stability::lost);
  EXPECT_NEAR(first_loss(all)->value, 1.0, 1e-9);
  // The range begins within an interval: it is told, and the critical value is above it.
  const StabilityProfile later = stability_over(A, {.from = 1.5, .to = 4.0, .count = 128});
  ASSERT_EQ(later.unstable.size(), 2u);
  EXPECT_EQ(later.unstable[0].from.value, 1.5);
  EXPECT_NEAR(later.unstable[0].from.growth, 0.375, 1e-9);
  EXPECT_NEAR(first_loss(later)->value, 3.0, 1e-9);
}

TEST(StabilitySearch, UntilALossLooksAtNothingFarAboveIt)
{
  const StateMatrixOf A =
      side_by_side({{[](double v) { return (v - 1.0) * (v - 2.0) * (v - 3.0); }, 5000.0},
                    {[](double) { return -40.0; }, 800.0}});
  double highest = 0.0;
  const StateMatrixOf watched = [&](double value) {
    highest = std::max(highest, value);
    return A(value);
  };
  const double distance = 3.9 / 127.0;
  for (const auto& [from, loss] : {std::pair(0.1, 1.0), std::pair(1.5, 3.0)}) {
    highest = 0.0;
    const SearchRange range{.from = from, .to = from + 3.9, .count = 128};
    const StabilityProfile found = stability_until_loss(watched, range);
    EXPECT_EQ(stability_of(found), Stability::lost);
    EXPECT_NEAR(first_loss(found)->value, first_loss(stability_over(A, range))->value, 1e-12);
    EXPECT_NEAR(first_loss(found)->value, loss, 1e-9);
    EXPECT_LE(highest, loss + distance);
  }
  // Where none is found, nothing is left out.
  const SearchRange regained{.from = 1.5, .to = 2.5, .count = 128};
  EXPECT_NEAR(first_regain(stability_until_loss(A, regained))->value, 2.0, 1e-9);
  EXPECT_EQ(stability_until_loss(A, regained).to.value, 2.5);
}

TEST(StabilitySearch, TellsStableFromUnstableInTheWholeRange)
{
  const StateMatrixOf A = side_by_side({{[](double v) { return v - 1.0; }, 5000.0}});
  const auto of = [&](double from, double to) {
    return stability_over(A, {.from = from, .to = to, .count = 128});
  };
  EXPECT_EQ(stability_of(of(0.1, 0.9)), Stability::stable);
  EXPECT_FALSE(first_loss(of(0.1, 0.9)));
  const StabilityProfile unstable = of(1.2, 3.0);
  EXPECT_EQ(stability_of(unstable), Stability::unstable);
  EXPECT_FALSE(first_loss(unstable));
  EXPECT_NEAR(unstable.from.growth, 0.2, 1e-9);
  EXPECT_NEAR(unstable.to.growth, 2.0, 1e-9);
  EXPECT_NEAR(unstable.from.frequency_Hz, 5000.0 / (2.0 * pi), 1e-6);
  const StateMatrixOf settles = side_by_side({{[](double v) { return 1.0 - v; }, 5000.0}});
  const StabilityProfile regained = stability_over(settles, {.from = 0.1, .to = 3.0, .count = 128});
  EXPECT_EQ(stability_of(regained), Stability::regained);
  EXPECT_FALSE(first_loss(regained));
  EXPECT_NEAR(first_regain(regained)->value, 1.0, 1e-9);
}

/// Growth h - (v - v0)^2, beside a motion that is less stable elsewhere and one that is neutral.
StateMatrixOf hidden_peak(double h, double v_0)
{
  return side_by_side({{[=](double v) { return h - (v - v_0) * (v - v_0); }, 5000.0},
                       {[](double) { return -1e-3; }, 7000.0},
                       {[](double) { return 0.0; }, 900.0}});
}

TEST(StabilitySearch, FindsAMaximumThatRisesAboveZeroBetweenTwoSamples)
{
  // Samples are 0.0787 apart; the interval is 0.02 wide and lies between two of them, next to the
  // ends of the range too.
  for (const double v_0 : {0.03, 3.3, 5.049, 5.01, 9.96}) {
    const StabilityProfile found =
        stability_over(hidden_peak(1e-4, v_0), {.from = 0.0, .to = 10.0, .count = 128});
    ASSERT_EQ(found.unstable.size(), 1u) << v_0;
    EXPECT_NEAR(found.unstable[0].from.value, v_0 - 0.01, 1e-6);
    EXPECT_NEAR(found.unstable[0].to.value, v_0 + 0.01, 1e-6);
  }
  EXPECT_TRUE(stability_over(hidden_peak(-1e-4, 3.3), {.from = 0.0, .to = 10.0, .count = 128})
                  .unstable.empty());
}

TEST(StabilitySearch, FindsAStableWindowBetweenTwoSamples)
{
  const StateMatrixOf A =
      side_by_side({{[](double v) { return (v - 3.3) * (v - 3.3) - 1e-4; }, 5000.0}});
  const StabilityProfile found = stability_over(A, {.from = 1.0, .to = 10.0, .count = 128});
  ASSERT_EQ(found.unstable.size(), 2u);
  EXPECT_NEAR(found.unstable[0].to.value, 3.29, 1e-8);
  EXPECT_NEAR(found.unstable[1].from.value, 3.31, 1e-8);
  EXPECT_NEAR(first_loss(found)->value, 3.31, 1e-8);
}

TEST(StabilitySearch, FindsModesThatCoupleOnlyWhereTheirFrequenciesMeet)
{
  // x^2 = c^2 - (k (v - v_0) / 2)^2 about their mean frequency, with the decay d of both: unstable
  // within 2 (c^2 - d^2)^(1/2) / k = 4e-3 of v_0, a twentieth of the distance of the samples, and
  // of the growth -d everywhere else.
  for (const double d : {3.0, 0.0}) {
    const double k = 2000.0, v_0 = 4.321, c = std::hypot(d, 4.0);
    const StateMatrixOf A = [=](double v) {
      const double half = 0.5 * k * (v - v_0), mean = 8000.0 + 70.0 * v + 3.0 * v * v;
      Eigen::Matrix2cd M;
      M << std::complex(-d, mean + half), c, c, std::complex(-d, mean - half);
      return realified(M);
    };
    const StabilityProfile found = stability_over(A, {.from = 0.0, .to = 10.0, .count = 128});
    ASSERT_EQ(found.unstable.size(), 1u) << d;
    EXPECT_NEAR(found.unstable[0].from.value, v_0 - 4e-3, 1e-8);
    EXPECT_NEAR(found.unstable[0].to.value, v_0 + 4e-3, 1e-8);
  }
}

TEST(StabilitySearch, CountsRigidAndUndampedMotionsAsStable)
{
  // A free body drifts linearly in time: a double eigenvalue 0, which rounding tears apart by the
  // root of 1e-16 of the frequency.
  const StateMatrixOf A = [](double v) {
    Eigen::MatrixXd A_v = Eigen::MatrixXd::Zero(6, 6);
    A_v.block<2, 2>(0, 0) << 0.0, 9000.0, 1e-13, 0.0;
    A_v.block<2, 2>(2, 2) << 0.0, 5000.0, -5000.0, 0.0;
    A_v.block<2, 2>(4, 4) << v - 1.0, 9000.0, -9000.0, v - 1.0;
    return A_v;
  };
  const StabilityProfile found = stability_over(A, {.from = 0.5, .to = 2.0, .count = 128});
  ASSERT_EQ(found.unstable.size(), 1u);
  EXPECT_NEAR(found.unstable[0].from.value, 1.0, 1e-7);
}

TEST(StabilitySearch, FindsStabilityLostWithoutOscillation)
{
  // A spring whose stiffness falls through zero: lambda^2 + 30 lambda + 1e6 (1 - v) = 0.
  const StateMatrixOf A = [](double v) {
    Eigen::MatrixXd A_v = Eigen::MatrixXd::Zero(4, 4);
    A_v.block<2, 2>(0, 0) << 0.0, 1000.0, -1000.0 * (1.0 - v), -30.0;
    A_v.block<2, 2>(2, 2) << -3.0, 5000.0, -5000.0, -3.0;
    return A_v;
  };
  const StabilityProfile found = stability_over(A, {.from = 0.5, .to = 2.0, .count = 128});
  ASSERT_EQ(found.unstable.size(), 1u);
  EXPECT_NEAR(found.unstable[0].from.value, 1.0, 1e-9);
  EXPECT_NEAR(found.unstable[0].from.frequency_Hz, 0.0, 1e-6);
}

TEST(StabilitySearch, AgreesWithADenseScanForRandomSystems)
{
  // Weakly damped modes that a non-symmetric stiffness and a gyroscopic term couple over the
  // parameter. A dense scan must see nothing else than the search.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int n_limits = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int n = 4;
    const auto matrix = [&] {
      return Eigen::MatrixXd::NullaryExpr(n, n, [&] { return unit(random); }).eval();
    };
    const Eigen::VectorXd omega =
        Eigen::VectorXd::NullaryExpr(n, [&] { return 3000.0 + 400.0 * unit(random); });
    const Eigen::MatrixXd Q = matrix(), R = matrix(), S = matrix();
    const Eigen::MatrixXd C = 8.0 * (R * R.transpose() + 0.2 * Eigen::MatrixXd::Identity(n, n));
    const StateMatrixOf A = [&](double v) {
      const Eigen::MatrixXd K = 4e5 * v * Q;
      const Eigen::MatrixXd G = 20.0 * v * (S - S.transpose());
      Eigen::MatrixXd A_v = Eigen::MatrixXd::Zero(2 * n, 2 * n);
      A_v.topRightCorner(n, n) = omega.asDiagonal();
      A_v.bottomLeftCorner(n, n) =
          -Eigen::MatrixXd(omega.asDiagonal()) - K * omega.cwiseInverse().asDiagonal();
      A_v.bottomRightCorner(n, n) = -C - G;
      return A_v;
    };
    const StabilityProfile found = stability_over(A, {.from = 0.01, .to = 4.0, .count = 128});
    for (const double v : Eigen::VectorXd::LinSpaced(2001, 0.01, 4.0)) {
      bool inside = false;
      for (const UnstableInterval& interval : found.unstable)
        inside = inside || (v >= interval.from.value && v <= interval.to.value);
      EXPECT_EQ(growth_of_matrix(A, v) > 0.0, inside) << "system " << trial << " at " << v;
    }
    for (const UnstableInterval& interval : found.unstable) {
      for (const StabilityPoint& limit : {interval.from, interval.to}) {
        if (limit.growth != 0.0) continue;
        ++n_limits;
        EXPECT_NEAR(growth_of_matrix(A, limit.value), 0.0, 1e-6);
        EXPECT_LT(growth_of_matrix(A, limit.value - 1e-6) * growth_of_matrix(A, limit.value + 1e-6),
                  0.0);
      }
    }
  }
  EXPECT_GT(n_limits, 60);
}

}  // namespace
}  // namespace chladni::squeal
