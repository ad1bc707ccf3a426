#include "squeal/motion/splitting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TransientCase braking()
{
  return {.speed = 20.0,
          .duration = 0.6,
          .initial_pad_displacement = 1e-6,
          .steps_per_period = 40,
          .speed_program = {{0.0, 20.0}, {0.1, 20.0}, {0.5, 0.0}}};
}

TEST(SpeedProgram, TurnsByTheIntegralOfItsSpeeds)
{
  const TransientCase run = braking();
  EXPECT_DOUBLE_EQ(turn_at(run, 0.05).angle, 1.0);
  EXPECT_DOUBLE_EQ(turn_at(run, 0.3).speed, 10.0);
  EXPECT_DOUBLE_EQ(turn_at(run, 0.3).angle, 2.0 + 0.2 * 15.0);
  EXPECT_DOUBLE_EQ(turn_at(run, 0.9).angle, 2.0 + 0.4 * 10.0);
  EXPECT_EQ(turn_at(run, 0.9).speed, 0.0);
}

TEST(SpeedProgram, OfOneSpeedIsAConstantSpeed)
{
  const Disc disc = disc_of({kirchhoff_3()});
  TransientCase run{.speed = 18.0,
                    .duration = 0.1,
                    .initial_pad_displacement = 1e-6,
                    .steps_per_period = 40,
                    .integrator = IntegratorKind::splitting};
  const auto constant = transient(FlexibleDisc(disc, reference_options()), run).tail.pad_velocity;
  run.speed_program = {{0.0, 18.0}, {0.05, 18.0}};
  const auto program = transient(FlexibleDisc(disc, reference_options()), run).tail.pad_velocity;
  ASSERT_EQ(constant.size(), program.size());
  for (std::size_t i = 0; i < constant.size(); i += 13)
    EXPECT_NEAR(program[i], constant[i], 1e-8 * 0.02);  // rounding of angles
}

TEST(SpeedProgram, BrakesToStandstillWithRegularisedFriction)
{
  // At rest friction damps: the regularised law is a damper of mu N_0 / eps.
  const Disc disc = disc_of({kirchhoff_3()});
  SquealOptions options = reference_options(ContactLaw::unilateral);
  EXPECT_THROW(transient(FlexibleDisc(disc, options), braking()), Error);
  options.friction.regularisation = 1e-3;
  const Transient run = transient(FlexibleDisc(disc, options), braking());
  ASSERT_TRUE(run.finished);
  EXPECT_EQ(run.speed, 0.0);
  EXPECT_FALSE(run.growth_rate);
  EXPECT_LT(run.slip_speed_min, 1e-3);
  double largest = 0.0;
  for (const double v : run.history.pad_velocity) largest = std::max(largest, std::abs(v));
  EXPECT_LT(std::abs(run.history.pad_velocity.back()), 0.1 * largest);
}

TEST(PreloadProgram, IsLinearBetweenItsPoints)
{
  TransientCase run = braking();
  EXPECT_EQ(preload_at(run, 0.3), 1.0);
  run.preload_program = {{0.1, 0.2}, {0.3, 1.2}};
  EXPECT_DOUBLE_EQ(turn_at(run, 0.05).preload, 0.2);
  EXPECT_DOUBLE_EQ(turn_at(run, 0.15).preload, 0.45);
  EXPECT_DOUBLE_EQ(turn_at(run, 0.5).preload, 1.2);
  EXPECT_EQ(turn_at(run, 0.3).speed, 10.0);
}

/// A short run with a plate behind the lining.
TransientCase short_program()
{
  return {.speed = 18.0,
          .duration = 0.1,
          .initial_pad_displacement = 1e-6,
          .steps_per_period = 40,
          .integrator = IntegratorKind::splitting};
}

SquealOptions with_plate()
{
  SquealOptions options = reference_options();
  options.pads.front().body = PadBody{.mass = 0.3,
                                      .tangential = Suspension{.stiffness = 5e7, .damping = 50.0},
                                      .axial = Suspension{.stiffness = 5e6, .damping = 50.0}};
  return options;
}

TEST(PreloadProgram, OfOneFactorIsAConstantPreload)
{
  SquealOptions more = reference_options();
  more.pads.front().preload *= 1.5;
  const Disc disc = disc_of({kirchhoff_3()});
  const auto constant = transient(FlexibleDisc(disc, more), short_program()).tail;
  TransientCase run = short_program();
  run.preload_program = {{0.0, 1.5}, {0.05, 1.5}};
  const auto program = transient(FlexibleDisc(disc, reference_options()), run).tail;
  ASSERT_EQ(constant.t.size(), program.t.size());
  for (std::size_t i = 0; i < constant.t.size(); i += 13) {
    // Rounding.
    EXPECT_NEAR(program.pad_velocity[i], constant.pad_velocity[i], 1e-10 * 0.02);
    EXPECT_NEAR(program.N_up[i], constant.N_up[i], 1e-10 * 3000.0);
  }
}

TEST(PreloadProgram, MovesTheEquilibriumOfPlatesToo)
{
  // What friction at rest holds of a plate is that of the preload of the moment: a plate counted
  // from another one would be pushed by 0.5 mu N_0, 12 um on its suspension, a hundred times this
  // motion. The step follows the stiffness of the contact, and so differs a little.
  SquealOptions more = with_plate();
  more.pads.front().preload *= 1.5;
  const Disc disc = disc_of({kirchhoff_3()});
  const auto largest = [](const std::vector<double>& x) {
    return *std::ranges::max_element(x, {}, [](double value) { return std::abs(value); });
  };
  const auto constant = transient(FlexibleDisc(disc, more), short_program()).tail;
  TransientCase run = short_program();
  run.preload_program = {{0.0, 1.5}};
  const auto program = transient(FlexibleDisc(disc, with_plate()), run).tail;
  EXPECT_NEAR(std::abs(largest(program.pad_velocity) / largest(constant.pad_velocity)), 1.0, 1e-2);
  EXPECT_NEAR(largest(program.N_up), largest(constant.N_up), 0.5);
}

/// Mean growth of the envelope over the last part of a run, 1/s.
double late_growth(const Transient& run, double from)
{
  const auto& [t, v, z] = run.envelope;
  const auto first = std::ranges::lower_bound(t, from) - t.begin();
  return std::log(v.back() / v[std::size_t(first)]) / (t.back() - t[std::size_t(first)]);
}

TEST(PreloadProgram, EndsWithTheGrowthOfAConstantRun)
{
  // 0.4 of the preload is stable at this speed, all of it squeals: friction goes with the preload.
  const Disc disc = disc_of({kirchhoff_3()});
  TransientCase run = short_program();
  run.duration = 2.0;
  const Transient constant = transient(FlexibleDisc(disc, reference_options()), run);
  run.preload_program = {{0.0, 0.4}, {0.5, 1.0}};
  const Transient ramp = transient(FlexibleDisc(disc, reference_options()), run);
  ASSERT_TRUE(ramp.finished);
  EXPECT_FALSE(ramp.growth_rate);
  const double expected = constant.growth_rate.value();
  EXPECT_GT(expected, 0.2);
  EXPECT_NEAR(late_growth(ramp, 1.0), expected, 0.02 * expected);
  // Normal forces about the preload of the end.
  EXPECT_NEAR(ramp.windows.N_up_min.front(), 0.4 * 2000.0, 20.0);
  EXPECT_NEAR(0.5 * (ramp.windows.N_up_min.back() + ramp.windows.N_up_max.back()), 2000.0, 20.0);
}

TEST(PreloadProgram, NeedsTheSplitting)
{
  TransientCase run = short_program();
  run.preload_program = {{0.0, 0.5}, {0.05, 1.0}};
  run.integrator = IntegratorKind::exponential;
  EXPECT_THROW(transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), run), Error);
}

TEST(SpeedProgram, NeedsTheSplitting)
{
  const Disc disc = disc_of({kirchhoff_3()});
  SquealOptions options = reference_options();
  options.friction.regularisation = 1e-3;
  TransientCase run = braking();
  run.integrator = IntegratorKind::exponential;
  EXPECT_THROW(transient(FlexibleDisc(disc, options), run), Error);
}

}  // namespace
}  // namespace chladni::squeal
