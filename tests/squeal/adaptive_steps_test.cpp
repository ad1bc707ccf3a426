#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "squeal/motion/dormand_prince.hpp"
#include "squeal/motion/generalised_alpha.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

/// x'' = -x above x = -c, and -stop x - (stop - 1) c below it: a mass that meets a stop. The motion
/// is made of two circles, so that everything is known in closed form.
class MassWithStop final : public Motion {
 public:
  MassWithStop(double c, double stop) : c_(c), stop_(stop), omega_(1), s_(1), f_(2)
  {
    omega_ << 1.0;
  }
  const Eigen::VectorXd& omega() const override { return omega_; }
  const Eigen::VectorXd& rate(double, const Eigen::VectorXd& y) override
  {
    s_[0] = y[0] + c_;
    f_ << y[1], -y[0] - (side_ < 0.0 ? (stop_ - 1.0) * (y[0] + c_) : 0.0);
    return f_;
  }
  const Eigen::VectorXd& switches() const override { return s_; }
  double side(Eigen::Index) const override { return side_; }
  void set_side(Eigen::Index, double side) override { side_ = side; }
  Tangent tangent(double, const Eigen::VectorXd&) override
  {
    return {Eigen::MatrixXd::Constant(1, 1, side_ < 0.0 ? -stop_ : -1.0),
            Eigen::MatrixXd::Zero(1, 1)};
  }

 private:
  double c_, stop_, side_ = 1.0;
  Eigen::VectorXd omega_, s_, f_;
};

/// x'' = -sin x, without switches.
class Pendulum final : public Motion {
 public:
  Pendulum() : omega_(Eigen::VectorXd::Ones(1)), f_(2) {}
  const Eigen::VectorXd& omega() const override { return omega_; }
  const Eigen::VectorXd& rate(double, const Eigen::VectorXd& y) override
  {
    f_ << y[1], -std::sin(y[0]);
    return f_;
  }
  const Eigen::VectorXd& switches() const override { return none_; }
  double side(Eigen::Index) const override { return 1.0; }
  void set_side(Eigen::Index, double) override {}
  Tangent tangent(double, const Eigen::VectorXd& y) override
  {
    return {Eigen::MatrixXd::Constant(1, 1, -std::cos(y[0])), Eigen::MatrixXd::Zero(1, 1)};
  }

 private:
  Eigen::VectorXd omega_, f_, none_;
};

double pendulum_energy(const Eigen::VectorXd& y)
{
  return 0.5 * y[1] * y[1] - std::cos(y[0]);
}

TEST(DormandPrince, KeepsItsToleranceBetweenTheStepsToo)
{
  // The energy of a pendulum at times that no step knows; 40 s are about 25 steps, each of which
  // may err by the tolerance, and the interpolation is one order lower than the step.
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    Pendulum motion;
    const Eigen::Vector2d start(2.0, 0.0);
    DormandPrince integrator(motion, 0.0, start, {tolerance, 10.0, 0.1});
    double largest = 0.0;
    for (double t = 0.05; t < 40.0; t += 0.0517) {
      largest =
          std::max(largest, std::abs(pendulum_energy(integrator.at(t)) - pendulum_energy(start)));
    }
    EXPECT_LT(largest, 100.0 * tolerance) << tolerance;
    EXPECT_GT(integrator.cost().n_steps, 5);
  }
}

TEST(DormandPrince, EndsAStepWhereASwitchingFunctionIsZero)
{
  // From x = 2 at rest: cos t reaches -1 / 2 at t = 2 pi / 3, where x' = -sqrt(3).
  MassWithStop motion(1.0, 100.0);
  DormandPrince integrator(motion, 0.0, Eigen::Vector2d(2.0, 0.0), {1e-11, 1.0, 0.1});
  // Below the stop x = -0.99 + A sin(10 t + phi) goes on from (-1, -sqrt 3) until it is back at -1,
  // and by symmetry the rest is the way back: period 2 (2 pi / 3 + half the time in contact).
  const double phase = std::atan2(0.01, std::sqrt(3.0) / 10.0);
  const double contact = (pi - 2.0 * phase) / 10.0;
  const double period = 4.0 * pi / 3.0 + contact;
  const Eigen::VectorXd end = integrator.at(5.0 * period);
  EXPECT_NEAR(end[0], 2.0,
              1e-9);  // about 150 steps of 1e-11, times 100 of the stiffness at the stop
  EXPECT_NEAR(end[1], 0.0, 1e-8);
  ASSERT_EQ(integrator.events().size(), 10u);
  EXPECT_NEAR(integrator.events()[0].t, 2.0 * pi / 3.0, 1e-10);
  EXPECT_EQ(integrator.events()[0].side, -1.0);
  EXPECT_NEAR(integrator.events()[1].t, 2.0 * pi / 3.0 + contact, 1e-10);
  EXPECT_EQ(integrator.events()[1].side, 1.0);
}

TEST(DormandPrince, SeesAPadThatLeavesAndReturnsWithinOneStep)
{
  // -cos t is below -0.9995 for 0.063 about t = 0 mod 2 pi; the steps are about 0.6.
  MassWithStop motion(0.9995, 1.5);
  DormandPrince integrator(motion, -pi, Eigen::Vector2d(1.0, 0.0), {1e-6, 1.0, 0.6});
  integrator.at(5.0 * pi);
  EXPECT_EQ(integrator.events().size(), 6u);
  EXPECT_LT(integrator.cost().n_steps, 60);
}

TEST(GeneralisedAlpha, IsOfSecondOrder)
{
  const auto error = [](double step) {
    Pendulum motion, reference;
    const Eigen::Vector2d start(1.5, 0.0);
    // A tolerance that never speaks: the largest step is taken throughout.
    GeneralisedAlpha integrator(motion, 0.0, start, {1.0, step, step});
    DormandPrince exact(reference, 0.0, start, {1e-13, 1.0, 0.1});
    return (integrator.at(3.0) - exact.at(3.0)).norm();
  };
  EXPECT_NEAR(std::log2(error(0.03) / error(0.015)), 2.0, 0.05);
}

TEST(GeneralisedAlpha, ChoosesItsStepsByTheTolerance)
{
  // An error of second order in the step is of order 2/3 in the tolerance of a step.
  const auto error = [](double tolerance) {
    Pendulum motion, reference;
    const Eigen::Vector2d start(1.5, 0.0);
    GeneralisedAlpha integrator(motion, 0.0, start, {tolerance, 1.0, 0.01});
    DormandPrince exact(reference, 0.0, start, {1e-13, 1.0, 0.1});
    return (integrator.at(30.0) - exact.at(30.0)).norm();
  };
  const double ratio = error(1e-4) / error(1e-7);
  EXPECT_GT(ratio, 30.0);
  EXPECT_LT(ratio, 300.0);
}

TEST(GeneralisedAlpha, DampsOnlyWithASpectralRadiusBelowOne)
{
  // x'' = -x at 8 steps for a period: with radius 1 the energy stays to the rounding and the Newton
  // error of 2000 steps, with 0.5 it is lost.
  const auto energy_after = [](double radius) {
    MassWithStop motion(1e3, 1.0);
    const Eigen::Vector2d start(1.0, 0.0);
    GeneralisedAlpha integrator(motion, 0.0, start, {1.0, 0.25 * pi, 0.25 * pi}, radius);
    const double end = 2000 * 0.25 * pi;
    return integrator.at(end).squaredNorm();
  };
  EXPECT_NEAR(energy_after(1.0), 1.0, 1e-11);
  EXPECT_LT(energy_after(0.5), 0.1);
}

}  // namespace
}  // namespace chladni::squeal
