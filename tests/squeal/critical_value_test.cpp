#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "common/error.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/stability/stability_search.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"
#include "tests/squeal/motions_side_by_side.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

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
  const FlexibleDisc brake(disc_on_ring(body, "track", {}), reference_options());
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
      SlidingBrake(o),
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
        SlidingBrake(o),
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

}  // namespace
}  // namespace chladni::squeal
