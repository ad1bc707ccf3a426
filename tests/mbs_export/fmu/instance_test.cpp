#include "mbs_export/fmu/instance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "models.hpp"

namespace chladni::fmu {
namespace {

using Eigen::VectorXd;

const References of(3, 2);

double value(const Instance& instance, std::uint32_t reference)
{
  return instance.values({&reference, 1}).front();
}

Instance moving()
{
  Instance instance(testing::three_modes());
  VectorXd x(6);
  x << 0.1, -0.2, 0.3, 1.0, 2.0, -3.0;
  instance.set_continuous_states(x);
  instance.set_value(of.forces(), 5.0);
  instance.set_value(of.forces() + 1, -7.0);
  return instance;
}

TEST(Instance, KeepsItsEquationOfMotion)
{
  const Instance instance = moving();
  const ModalModel model = testing::three_modes();
  const State& state = instance.state();
  const VectorXd q_ddot = instance.derivatives().tail(3);
  const VectorXd residual = q_ddot + model.C * state.q_dot +
                            model.omega.cwiseAbs2().cwiseProduct(state.q) -
                            model.Phi.transpose() * state.F;
  EXPECT_LT(residual.norm(), 1e-13 * q_ddot.norm());
  EXPECT_NEAR(value(instance, of.displacements() + 1), model.Phi.row(1).dot(state.q), 1e-15);
  EXPECT_NEAR(value(instance, of.velocities()), model.Phi.row(0).dot(state.q_dot), 1e-15);
  EXPECT_NEAR(value(instance, of.accelerations() + 1), model.Phi.row(1).dot(q_ddot), 1e-9);
  EXPECT_EQ(value(instance, of.der_q() + 2), state.q_dot[2]);
  EXPECT_EQ(value(instance, of.der_q_dot() + 2), q_ddot[2]);
}

TEST(Instance, IsDampedByItsParameters)
{
  Instance instance = moving();
  const VectorXd before = instance.derivatives();
  instance.set_value(References::damping_factor, 0.0);
  const VectorXd undamped = instance.derivatives();
  const VectorXd damping = testing::three_modes().C * instance.state().q_dot;
  EXPECT_TRUE((undamped - before).tail(3).isApprox(damping, 1e-9));
  instance.set_value(of.damping_ratios() + 1, 0.1);
  EXPECT_NEAR((undamped - instance.derivatives())[4], 2.0 * 0.1 * 40.0 * 2.0, 1e-9);
}

/// Small steps of an integrator of order 4 come to the same place as one exact step.
TEST(Instance, AdvancesAsItsDerivativesSay)
{
  Instance exact = moving();
  exact.advance(0.01);
  Instance small = moving();
  constexpr int n = 4000;
  const double h = 0.01 / n;
  const auto slope = [&](const VectorXd& x) {
    small.set_continuous_states(x);
    return small.derivatives();
  };
  VectorXd x = small.continuous_states();
  for (int i = 0; i < n; ++i) {
    const VectorXd k1 = slope(x), k2 = slope(x + h / 2.0 * k1), k3 = slope(x + h / 2.0 * k2),
                   k4 = slope(x + h * k3);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  // Of order 4: (omega h)^4 is 3e-11 here.
  EXPECT_LT((x - exact.continuous_states()).norm(), 1e-9 * x.norm());
  EXPECT_NEAR(exact.state().time, 0.01, 1e-16);
}

/// What is kept of the last step must not be used for another.
TEST(Instance, StepsAnewWhenStepOrDampingChange)
{
  Instance one = moving(), other = moving();
  one.advance(0.01);
  one.advance(0.02);
  other.advance(0.03);
  EXPECT_LT((one.continuous_states() - other.continuous_states()).norm(), 1e-9);
  one.set_value(References::damping_factor, 0.0);
  const VectorXd before = one.snapshot();
  one.advance(0.02);
  Instance fresh(testing::three_modes());
  fresh.restore(before);
  fresh.advance(0.02);
  EXPECT_LT((one.continuous_states() - fresh.continuous_states()).norm(), 1e-12);
}

TEST(Instance, HasItsDirectionalDerivatives)
{
  const Instance instance = moving();
  const std::vector<std::uint32_t> unknowns{of.accelerations(), of.der_q_dot() + 1,
                                            of.displacements(), of.velocities() + 1};
  const std::vector<std::uint32_t> knowns{of.forces() + 1, of.q() + 2, of.q_dot() + 1,
                                          References::time};
  std::vector<double> changes;
  Instance moved = instance;
  for (const std::uint32_t known : knowns) {
    changes.push_back(0.25 * (double(changes.size()) + 1.0));
    moved.set_value(known, value(instance, known) + changes.back());
  }
  const std::vector<double> found = instance.directional_derivatives(unknowns, {knowns, changes});
  const std::vector<double> before = instance.values(unknowns), after = moved.values(unknowns);
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    EXPECT_NEAR(found[i], after[i] - before[i], 1e-13 * std::abs(after[i]) + 1e-12);
}

TEST(Instance, RefusesWhatIsNoVariable)
{
  Instance instance = moving();
  EXPECT_THROW(value(instance, of.end()), Error);
  EXPECT_THROW(instance.set_value(of.displacements(), 0.0), Error);
  EXPECT_THROW(instance.set_value(of.der_q(), 0.0), Error);
  EXPECT_THROW(instance.set_value(of.forces(), std::numeric_limits<double>::infinity()), Error);
  EXPECT_THROW(instance.advance(0.0), Error);
  EXPECT_THROW(instance.advance(-1.0), Error);
  const std::vector<std::uint32_t> parameter{References::damping_factor};
  const std::vector<double> one{1.0};
  EXPECT_THROW(instance.directional_derivatives({}, {parameter, one}), Error);
}

TEST(Instance, ComesBackToWhatWasKept)
{
  Instance instance = moving();
  instance.set_value(References::damping_factor, 0.5);
  instance.set_value(of.damping_ratios() + 2, 0.25);
  instance.set_time(3.0);
  const VectorXd kept = instance.snapshot(), derivatives = instance.derivatives();
  instance.reset();
  instance.restore(kept);
  EXPECT_EQ(instance.snapshot(), kept);
  EXPECT_EQ(instance.derivatives(), derivatives);
  EXPECT_EQ(instance.time(), 3.0);
}

TEST(Instance, ComesBackToItsStart)
{
  Instance instance = moving();
  instance.set_value(References::damping_factor, 3.0);
  instance.advance(0.01);
  instance.reset();
  EXPECT_EQ(instance.continuous_states().norm(), 0.0);
  EXPECT_EQ(instance.state().F.norm(), 0.0);
  EXPECT_EQ(instance.state().time, 0.0);
  EXPECT_EQ(instance.state().damping_factor, 1.0);
}

}  // namespace
}  // namespace chladni::fmu
