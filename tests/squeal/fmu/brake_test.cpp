// A brake as FMUs simulate it, beside the motions that `squeal` integrates.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/error.hpp"
#include "squeal/fmu/brake_simulation.hpp"
#include "squeal/fmu/driven_brake.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::brake_fmu {
namespace {

using Eigen::Index, Eigen::VectorXd;
using squeal::test::disc_of, squeal::test::kirchhoff_2, squeal::test::kirchhoff_3;

constexpr double speed = 18.8;

squeal::SquealOptions options_of(squeal::ContactLaw law)
{
  const squeal::PadBody body{.mass = 0.3,
                             .axial = squeal::Suspension{1e7, 20.0},
                             .about_radial = squeal::RotarySuspension{1e-4, {2e3, 0.01}}};
  return {.ring = "track",
          .thickness = 0.02,
          .modes = {},
          .friction = {.kinetic = 0.5, .rise = 0.1, .decay_speed = 0.7},
          .contact = law,
          .pads = {{.angle = 0.3, .stiffness = 6e6, .damping = 4.0, .preload = 2000.0},
                   {.angle = 2.0,
                    .stiffness = 5e6,
                    .damping = 2.0,
                    .preload = 1500.0,
                    .cubic_stiffness = 1e15,
                    .grid = squeal::PadGrid{.sector = 0.4, .points = 3},
                    .body = body}},
          .study = {}};
}

squeal::Disc two_pairs()
{
  return disc_of({kirchhoff_2(), kirchhoff_3()});
}

BrakeModel model_of(const squeal::SquealOptions& options)
{
  squeal::Disc disc = two_pairs();
  squeal::PadSystem pads = squeal::pad_system(options, squeal::ring_places(disc));
  return {.token = "token",
          .disc = std::move(disc),
          .pads = std::move(pads),
          .friction = options.friction.kinetic,
          .speed = speed};
}

/// States of the size of `amplitude` m and of the speeds that belong to it.
VectorXd random_state(const BrakeModel& model, double amplitude)
{
  std::mt19937 dice(3);
  std::normal_distribution<double> normal;
  VectorXd x(1 + 2 * model.n_modes());
  for (double& value : x) value = amplitude * normal(dice);
  x[0] = 0.7;
  x.tail(model.n_modes()) *= 1e4;
  return x;
}

class BrakeOfLaw : public ::testing::TestWithParam<squeal::ContactLaw> {};

/// In contact and, with ten times the amplitude, with pads that let go or pull.
TEST_P(BrakeOfLaw, AcceleratesAsTheTurningDiscOfSqueal)
{
  const squeal::SquealOptions options = options_of(GetParam());
  const squeal::Disc disc = two_pairs();
  const BrakeModel model = model_of(options);
  const Index n = model.n_modes();
  squeal::RotatingDisc reference(disc, options, speed);
  BrakeSimulation simulation(model_of(options));
  for (const double amplitude : {1e-6, 3e-4, 3e-3}) {
    const VectorXd x = random_state(model, amplitude);
    simulation.set_continuous_states(x);
    VectorXd y(2 * n);
    y << reference.omega().cwiseProduct(x.segment(1, n)), x.tail(n);
    reference.take_sides(x[0] / speed, y);
    const VectorXd expected = reference.rate(x[0] / speed, y).tail(n);
    const VectorXd found = simulation.derivatives().tail(n);
    EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm()) << amplitude;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, BrakeOfLaw,
                         ::testing::Values(squeal::ContactLaw::bilateral,
                                           squeal::ContactLaw::unilateral,
                                           squeal::ContactLaw::signed_force));

/// Inputs are what the options of a scene would be.
TEST(Brake, IsDrivenByItsInputs)
{
  squeal::SquealOptions changed = options_of(squeal::ContactLaw::unilateral);
  changed.friction.kinetic = 0.3;
  changed.pads[0].preload = 2500.0;
  changed.pads[1].preload = 900.0;
  BrakeModel other = model_of(changed);
  other.speed = 9.0;
  BrakeSimulation expected(std::move(other));
  BrakeSimulation found(model_of(options_of(squeal::ContactLaw::unilateral)));
  const VectorXd x = random_state(model_of(changed), 2e-4);
  expected.set_continuous_states(x);
  found.set_continuous_states(x);
  const BrakeReferences of((x.size() - 1) / 2, 2);
  found.set_value(BrakeReferences::speed, 9.0);
  found.set_value(BrakeReferences::friction, 0.3);
  found.set_value(of.preloads(), 2500.0);
  found.set_value(of.preloads() + 1, 900.0);
  EXPECT_LT((found.derivatives() - expected.derivatives()).norm(),
            1e-12 * expected.derivatives().norm());
}

/// Of order 8: half the step leaves 1/256 of the error, a little more before the error is small.
TEST(Brake, AdvancesWithOrderEight)
{
  const auto end = [](double steps_per_period) {
    BrakeSimulation simulation(model_of(options_of(squeal::ContactLaw::signed_force)));
    simulation.set_continuous_states(
        random_state(model_of(options_of(squeal::ContactLaw::signed_force)), 1e-6));
    simulation.set_value(BrakeReferences::steps_per_period, steps_per_period);
    simulation.advance(2e-3);
    return simulation.continuous_states();
  };
  const VectorXd exact = end(60.0);
  const double coarse = (end(10.0) - exact).norm(), fine = (end(20.0) - exact).norm();
  EXPECT_GT(std::log2(coarse / fine), 7.5);
  EXPECT_LT((end(usual_steps_per_period) - exact).norm(), 1e-11 * exact.norm());
}

TEST(Brake, RestsInTheSlidingEquilibrium)
{
  BrakeSimulation simulation(model_of(options_of(squeal::ContactLaw::unilateral)));
  const BrakeReferences of((simulation.continuous_states().size() - 1) / 2, 2);
  simulation.advance(1e-3);
  const VectorXd x = simulation.continuous_states();
  EXPECT_NEAR(x[0], speed * 1e-3, 1e-12);
  EXPECT_LT(x.tail(x.size() - 1).norm(), 1e-9);
  const auto value = [&](std::uint32_t reference) {
    return simulation.values({&reference, 1}).front();
  };
  EXPECT_NEAR(value(of.pads()), 2000.0, 1e-6) << "normal force of the first pad";
  // mu (N_0 + N_1) on both sides of a ring of some radius, against the rotation.
  const double radius = two_pairs().rings.front().radius;
  const double mu = 0.5 + 0.1 * std::exp(-speed * radius / 0.7);
  EXPECT_NEAR(value(of.torque()), -2.0 * mu * (2000.0 + 1500.0) * radius, 1e-5);
}

TEST(Brake, RefusesWhatNoBrakeDoes)
{
  BrakeSimulation simulation(model_of(options_of(squeal::ContactLaw::unilateral)));
  const BrakeReferences of((simulation.continuous_states().size() - 1) / 2, 2);
  EXPECT_THROW(simulation.set_value(of.torque(), 1.0), Error);
  EXPECT_THROW(simulation.set_value(of.end(), 1.0), Error);
  EXPECT_THROW(simulation.set_value(BrakeReferences::steps_per_period, 0.5), Error);
  EXPECT_THROW(simulation.advance(-1.0), Error);
  simulation.set_value(of.preloads(), 0.0);
  EXPECT_THROW(simulation.derivatives(), Error);
  simulation.reset();
  simulation.set_value(BrakeReferences::speed, 0.0);
  EXPECT_THROW(simulation.advance(1e-4), Error);
  simulation.reset();
  EXPECT_NO_THROW(simulation.advance(1e-4));
}

TEST(Brake, ComesBackToWhatWasKept)
{
  BrakeSimulation simulation(model_of(options_of(squeal::ContactLaw::unilateral)));
  simulation.set_continuous_states(
      random_state(model_of(options_of(squeal::ContactLaw::unilateral)), 1e-4));
  simulation.set_value(BrakeReferences::friction, 0.2);
  simulation.set_value(BrakeReferences::speed, 11.0);
  const VectorXd kept = simulation.snapshot();
  simulation.advance(1e-3);
  const VectorXd once = simulation.continuous_states();
  simulation.reset();
  simulation.restore(kept);
  simulation.advance(1e-3);
  EXPECT_EQ(simulation.continuous_states(), once);
}

TEST(BrakeFile, ComesBackWithTheSameMotion)
{
  const squeal::SquealOptions options = options_of(squeal::ContactLaw::unilateral);
  const BrakeModel model = model_of(options);
  const VectorXd x = random_state(model, 3e-4);
  BrakeSimulation one(model_of(options)), other(unpacked_brake(packed(model)));
  one.set_continuous_states(x);
  other.set_continuous_states(x);
  EXPECT_EQ(one.derivatives(), other.derivatives());
}

TEST(BrakeFile, ThatIsCutOffOrDamagedIsRefused)
{
  const std::string bytes = packed(model_of(options_of(squeal::ContactLaw::unilateral)));
  for (std::size_t n = 0; n < bytes.size(); n += 61)
    EXPECT_THROW(unpacked_brake(bytes.substr(0, n)), Error) << n << " bytes";
  EXPECT_THROW(unpacked_brake(bytes + "x"), Error);
  std::mt19937 dice(1);
  int n_refused = 0;
  constexpr int n_tries = 300;
  for (int i = 0; i < n_tries; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 8; ++k) damaged[20 + dice() % (bytes.size() - 20)] = char(dice());
    try {
      BrakeSimulation simulation(unpacked_brake(damaged));
      simulation.derivatives();
    } catch (const Error&) {
      ++n_refused;
    }
  }
  RecordProperty("refused", n_refused);
}

}  // namespace
}  // namespace chladni::brake_fmu
