#include "squeal/motion/speed_program.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/error.hpp"
#include "references/squeal/analytic_body.hpp"
#include "squeal/transient/transient.hpp"

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
