#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "source_disc.hpp"
#include "squeal/cycle/limit_cycle_branch.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/study/study.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;
using test::source_disc;

ModelOptions study_of_rigid_disc(const RigidDiscStudy& study)
{
  return {.model = study,
          .study = {.speeds = {.from = pi, .to = 20.0 * pi, .count = 20},
                    .analyses = {"eigenvalues", "critical-speed"}}};
}

SquealResults results_of_study(const ModelOptions& options)
{
  return run(*model_brake(options), options.study);
}

/// SQUEAL reference values at 20 pi by shooting over the kinks of the contact law with finite
/// differences: the multipliers along their cycles are 1 to 6e-6 and 6e-5 only.
struct ModelReference {
  ContactLaw law;
  double frequency_Hz, velocity, tolerance;
};

TEST(RigidModel, HasTheLimitCyclesOfTheReferenceDirectly)
{
  const ModelReference references[] = {{ContactLaw::bilateral, 1740.888105, 11.521439, 1e-4},
                                       {ContactLaw::unilateral, 1737.862, 59.034, 1e-4},
                                       {ContactLaw::signed_force, 1740.619, 64.689, 1e-4}};
  for (const ModelReference& reference : references) {
    SCOPED_TRACE(static_cast<int>(reference.law));
    ModelOptions options = study_of_rigid_disc({.disc = source_disc(reference.law)});
    options.study.analyses = {"limit-cycle-direct"};
    options.study.limit_cycle_direct = DirectCase{20.0 * pi};
    const DirectLimitCycle cycle = results_of_study(options).limit_cycle_direct.value();
    EXPECT_NEAR(cycle.frequency_Hz, reference.frequency_Hz, 1e-3);
    EXPECT_NEAR(cycle.pad_velocity, reference.velocity, reference.tolerance * reference.velocity);
    EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
    EXPECT_EQ(stability_of(cycle), CycleStability::stable);
  }
}

TEST(RigidModel, HasAMapWhoseBoundaryIsTheCriticalSpeed)
{
  ModelOptions options = study_of_rigid_disc({.disc = source_disc()});
  options.study.analyses = {"stability-map", "critical-speed", "critical-values"};
  options.study.speeds = {.from = 5.0 * pi, .to = 15.0 * pi, .count = 21};
  options.study.map =
      MapCase{.parameter = MapParameter::friction, .from = 0.5, .to = 0.7, .count = 3};
  options.study.critical = {
      {.parameter = MapParameter::friction, .from = 0.3, .to = 0.9, .speed = 12.0 * pi}};
  const SquealResults results = results_of_study(options);
  const StabilityMap& map = results.map.value();
  for (Eigen::Index j = 0; j < map.speeds.size(); ++j)
    EXPECT_EQ(map.growth(1, j) > 0.0, map.speeds[j] > results.critical_speed->speed);
  // The critical friction at 12 pi is that at which 12 pi is the critical speed.
  ASSERT_TRUE(results.critical_values.at(0).value);
  RigidDisc disc = source_disc();
  disc.friction.kinetic = *results.critical_values[0].value;
  const auto critical =
      critical_speed(stability_over_speed(state_matrix_at(RigidDiscBrake({.disc = disc})),
                                          {.from = 5.0 * pi, .to = 20.0 * pi, .count = 2}));
  EXPECT_NEAR(critical.value().speed, 12.0 * pi, 1e-6);
}

TEST(RigidModel, HasNoLimitCycleInItsLinearEquations)
{
  ModelOptions options =
      study_of_rigid_disc({.disc = source_disc(), .equations = RigidEquations::linear});
  options.study.analyses = {"limit-cycle-direct"};
  options.study.limit_cycle_direct = DirectCase{20.0 * pi};
  EXPECT_THROW(results_of_study(options), Error);
}

/// A mass on a belt whose friction falls over the speed, with enough damping to be stable above
/// V_c = -v_s ln(d_x v_s / (N_0 rise)).
Oscillator falling_friction()
{
  return {.mass = 2.0,
          .k_x = 4e4,
          .k_y = 4e6,
          .k_xy = 1e5,  // so that the pad moves too
          .d_x = 60.0,
          .d_y = 400.0,
          .contact_stiffness = 7e6,
          .preload = 500.0,
          .radius = 0.13,
          .friction = {.kinetic = 0.3, .rise = 0.3, .decay_speed = 0.5, .regularisation = 2e-2}};
}

TEST(Oscillator, SticksAndSlipsBesideStableSliding)
{
  // Where the slope of friction no longer outweighs the damping, sliding becomes stable; the
  // stick-slip cycle lives on above that speed and vanishes in a fold: hysteresis.
  const Oscillator o = falling_friction();
  const double V_c = -0.5 * std::log(60.0 * 0.5 / (500.0 * 0.3));
  const SlidingBrake model(o);
  EXPECT_GT(least_stable_eigenvalue(model.state_matrix(0.98 * V_c / o.radius)).real(), 0.0);
  EXPECT_LT(least_stable_eigenvalue(model.state_matrix(1.02 * V_c / o.radius)).real(), 0.0);
  const LimitCycleBranch branch = limit_cycle_branch(
      model, {.from = 0.5 * V_c / o.radius, .to = 1.5 * V_c / o.radius, .count = 41});
  ASSERT_FALSE(branch.points.empty());
  ASSERT_TRUE(branch.origin);
  EXPECT_NEAR(branch.origin->speed * o.radius, V_c, 1e-2 * V_c);
  bool stable_above = false;
  for (const BranchPoint& point : branch.points)
    stable_above |= point.speed * o.radius > V_c && point.largest_multiplier < 1.0;
  EXPECT_TRUE(stable_above);
  ASSERT_FALSE(branch.folds.empty());
  EXPECT_GT(branch.folds.back().speed * o.radius, V_c);
}

}  // namespace
}  // namespace chladni::squeal
