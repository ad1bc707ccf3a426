#include "squeal/stability/stability_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <random>
#include <vector>

#include "common/error.hpp"
#include "references/squeal/kirchhoff_modes.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/models/oscillator.hpp"
#include "squeal/stability/stability.hpp"
#include "squeal/stability/stability_map.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// A real matrix with the eigenvalues of M and their conjugates.
Eigen::MatrixXd realified(const Eigen::MatrixXcd& M)
{
  Eigen::MatrixXd A(2 * M.rows(), 2 * M.cols());
  A << M.real(), -M.imag(), M.imag(), M.real();
  return A;
}

/// A motion that grows by itself.
struct Single {
  std::function<double(double)> growth;
  double omega;
};

StateMatrixOf side_by_side(const std::vector<Single>& motions)
{
  return [motions](double value) {
    const auto n = static_cast<Eigen::Index>(motions.size());
    Eigen::MatrixXcd M = Eigen::MatrixXcd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Single& motion = motions[static_cast<std::size_t>(i)];
      M(i, i) = {motion.growth(value), motion.omega};
    }
    return realified(M);
  };
}

/// Motions side by side as a brake whose parameters are all the one value.
class Motions final : public Brake {
 public:
  explicit Motions(StateMatrixOf A, double value = 0.0) : A_(std::move(A)), value_(value) {}

  Eigen::MatrixXd state_matrix(double /*speed*/) const override { return A_(value_); }
  std::unique_ptr<Brake> with(MapParameter /*parameter*/, double value) const override
  {
    return std::make_unique<Motions>(A_, value);
  }
  std::unique_ptr<AutonomousMotion> motion(double /*speed*/) const override
  {
    throw Error("these motions are linear: none of them is a limit cycle");
  }
  double rest_compression() const override { return 1.0; }

 private:
  StateMatrixOf A_;
  double value_;
};

double growth_at(const StateMatrixOf& A, double value)
{
  return least_stable_eigenvalue(A(value)).real();
}

TEST(CriticalValue, IsTheFirstOfTwoMotionsWhereverTheRangeEnds)
{
  // A second motion loses its stability a little later and grows faster: at the next sample it is
  // the least stable one, and Newton's method would lead to its own limit, 0.06718. Which of the
  // two a sample sees depends on the upper end of the range.
  const StateMatrixOf A =
      side_by_side({{[](double mu) { return 40.0 * (mu - 0.06240); }, 9000.0},
                    {[](double mu) { return 900.0 * (mu - 0.06718); }, 10500.0}});
  for (const double to : {0.1, 0.2, 0.4, 0.5, 0.7, 1.0, 1.3, 2.0, 5.0}) {
    const CriticalValue found = critical_value(
        Motions(A), {.parameter = MapParameter::friction, .from = 0.01, .to = to, .speed = 10.0});
    ASSERT_TRUE(found.value) << to;
    // Growth is known to rounding, 1e-12 of the frequency, and has a slope of 40.
    EXPECT_NEAR(*found.value, 0.06240, 1e-9) << to;
    EXPECT_NEAR(found.frequency_Hz, 9000.0 / (2.0 * pi), 1e-6) << to;
  }
}

TEST(CriticalValue, OfADiscOfManyModesIsTheLowestWhereverTheRangeEnds)
{
  // Two motions lose their stability at 0.0197 and 0.0229, with the slopes of their growth such
  // that 64 values up to 0.6 show the second one first.
  auto body = analytic_body(kirchhoff_modes());
  body.C = (2.0 * 2e-5 * body.omega).asDiagonal();
  const FlexibleDisc brake(make_disc(body, "track", {}), reference_options());
  const double speed = 31.4;
  const auto growth = [&](double mu) {
    return least_stable_eigenvalue(brake.with(MapParameter::friction, mu)->state_matrix(speed))
        .real();
  };
  for (const double to : {0.25, 0.4, 0.6, 1.0}) {
    const CriticalValue found = critical_value(
        brake, {.parameter = MapParameter::friction, .from = 0.01, .to = to, .speed = speed});
    ASSERT_TRUE(found.value) << to;
    EXPECT_NEAR(*found.value, 0.019673, 1e-6) << to;
    EXPECT_NEAR(growth(*found.value), 0.0, 1e-8) << to;  // 1e-13 of the highest frequency
    EXPECT_LT(growth(*found.value * (1.0 - 1e-4)), -1e-6) << to;
    EXPECT_GT(growth(*found.value * (1.0 + 1e-4)), 1e-6) << to;
  }
}

/// The oscillator with equal damping of both motions.
Oscillator damped_belt(double d)
{
  return {.mass = 1.0,
          .k_x = 1.2e7,
          .k_y = 4e6,
          .k_xy = 1e6,
          .d_x = d,
          .d_y = d,
          .contact_stiffness = 7e6,
          .preload = 500.0,
          .radius = 0.13,
          .friction = {0.1}};
}

CriticalValue critical_friction(const Oscillator& o, double from, double to)
{
  return critical_value(
      OscillatorBrake(o),
      {.parameter = MapParameter::friction, .from = from, .to = to, .speed = 10.0});
}

TEST(CriticalValue, OfTwoModesThatCoupleIsThatOfTheClosedForm)
{
  // The squared frequencies are a +- i b, a = trace(K) / 2, b^2 = det(K) - a^2. Growth is zero
  // where -omega^2 + i omega d + a - i b = 0: omega^2 = a, b^2 = d^2 a; det(K) is linear in mu.
  for (const double d : {5.0, 50.0, 300.0}) {
    const Oscillator o = damped_belt(d);
    const double a = 0.5 * (o.k_x + o.k_y + o.contact_stiffness);
    const double expected =
        (a * a + d * d * a - o.k_x * (o.k_y + o.contact_stiffness) + o.k_xy * o.k_xy) /
        (o.k_xy * o.contact_stiffness);
    for (const double to : {0.5, 1.0, 3.0}) {
      const CriticalValue found = critical_friction(o, 0.01, to);
      ASSERT_TRUE(found.value) << d;
      EXPECT_NEAR(*found.value, expected, 1e-9 * expected) << d;
      EXPECT_NEAR(found.frequency_Hz, std::sqrt(a) / (2.0 * pi), 1e-6);
    }
  }
}

TEST(CriticalValue, OfUndampedModesIsWhereTheirFrequenciesMeet)
{
  // Below it both motions are neutral: neither grows, and neither decays. Beside it the growth goes
  // with the root of the distance.
  const CriticalValue found = critical_friction(damped_belt(0.0), 0.01, 1.0);
  ASSERT_TRUE(found.value);
  EXPECT_NEAR(*found.value, flutter_friction(damped_belt(0.0)), 1e-10);
  EXPECT_EQ(stability_of(*found.profile), Stability::lost);
  EXPECT_EQ(found.profile->unstable.size(), 1u);
}

TEST(CriticalValue, OfTheStiffnessIsLostAndRegainedWhereTheClosedFormSays)
{
  // Undamped modes couple where ((k_x - k_y - k_c) / 2)^2 + k_xy^2 < mu k_xy k_c, between the two
  // roots in k_c; a range that begins between them only regains stability.
  Oscillator o = damped_belt(0.0);
  o.friction.kinetic = 0.185;
  const double sum = 2.0 * (o.k_x - o.k_y) + 4.0 * o.friction.kinetic * o.k_xy;
  const double product = std::pow(o.k_x - o.k_y, 2) + 4.0 * o.k_xy * o.k_xy;
  const double root = std::sqrt(0.25 * sum * sum - product);
  const double low = 0.5 * sum - root, high = 0.5 * sum + root;
  const auto critical_stiffness = [&](double from) {
    return critical_value(
        OscillatorBrake(o),
        {.parameter = MapParameter::stiffness, .from = from, .to = 2e7, .speed = 10.0});
  };
  const CriticalValue lost = critical_stiffness(1e6);
  EXPECT_NEAR(lost.value.value(), low, 1e-9 * low);
  ASSERT_EQ(lost.profile->unstable.size(), 1u);
  EXPECT_NEAR(lost.profile->unstable[0].to.value, high, 1e-9 * high);
  const CriticalValue regained = critical_stiffness(7e6);
  EXPECT_EQ(stability_of(*regained.profile), Stability::regained);
  EXPECT_NEAR(regained.value.value(), high, 1e-9 * high);
  EXPECT_EQ(regained.profile->unstable[0].from.value, 7e6);
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
      EXPECT_EQ(growth_at(A, v) > 0.0, inside) << "system " << trial << " at " << v;
    }
    for (const UnstableInterval& interval : found.unstable) {
      for (const StabilityPoint& limit : {interval.from, interval.to}) {
        if (limit.growth != 0.0) continue;
        ++n_limits;
        EXPECT_NEAR(growth_at(A, limit.value), 0.0, 1e-6);
        EXPECT_LT(growth_at(A, limit.value - 1e-6) * growth_at(A, limit.value + 1e-6), 0.0);
      }
    }
  }
  EXPECT_GT(n_limits, 60);
}

}  // namespace
}  // namespace chladni::squeal
