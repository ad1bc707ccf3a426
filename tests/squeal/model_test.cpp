#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "source_disc.hpp"
#include "squeal/models/brake.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/study/study.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;
using test::source_disc;

ModelOptions rigid_study(const RigidDiscStudy& study)
{
  return {.model = study,
          .study = {.speeds = {.from = pi, .to = 20.0 * pi, .count = 20},
                    .analyses = {"eigenvalues", "critical-speed"}}};
}

SquealResults of_study(const ModelOptions& options)
{
  return run(*model_brake(options), options.study);
}

TEST(RigidModel, HasTheEigenvaluesAndTheCriticalSpeedOfTheReference)
{
  // SQUEAL reference values with 40 digits. State matrices by complex steps carry the rounding of
  // moments of 1e3 N m over 0.16 kg m^2: 1e-9 1/s.
  for (const Drive drive : {Drive::speed, Drive::moment}) {
    const SquealResults results = of_study(rigid_study({.disc = source_disc(), .drive = drive}));
    const auto& map = results.eigenvalues.value();
    ASSERT_EQ(map.lambda.cols(), 2);
    const std::complex<double> at_pi(-3.4347768016379, 10898.22890054795);
    const std::complex<double> at_5_pi(-0.65718126944039, 10902.04349243849);
    const std::complex<double> at_20_pi(0.49272654730206, 10938.38259488658);
    EXPECT_LT(std::abs(map.lambda(0, 1) - at_pi), 1e-8);
    EXPECT_LT(std::abs(map.lambda(4, 1) - at_5_pi), 1e-8);
    EXPECT_LT(std::abs(map.lambda(19, 1) - at_20_pi), 1e-8);
    // The growth rate rises by 0.03 per unit of speed.
    EXPECT_NEAR(results.critical_speed->speed / pi, 9.478465586019481, 1e-7);
    EXPECT_NEAR(results.critical_speed->frequency_Hz * 2.0 * pi, 10910.641291, 1e-6);
  }
}

TEST(RigidModel, GrowsInTimeAsItsEigenvaluesSay)
{
  // Order 8 with 40 steps per period leaves nothing. The other mode, which decays by 1.8 per
  // second, is down to exp(-2.3 2) of the growing one where the fit begins, and beats with it.
  for (const RigidEquations equations : {RigidEquations::linear, RigidEquations::nonlinear}) {
    const Growth result = growth(
        RigidDiscBrake({.disc = source_disc(), .drive = Drive::speed, .equations = equations}),
        20.0 * pi, 4.0);
    EXPECT_NEAR(result.eigenvalue_rate.value(), 0.49272654730206, 1e-8);
    EXPECT_NEAR(result.rate, 0.49272654730206, 5e-4);
  }
}

TEST(RigidModel, SettlesOnTheLimitCycleOfTheReferenceOnlyWithNonlinearEquations)
{
  // SQUEAL reference values by shooting; by its multipliers, disturbances decay by 0.6 per second,
  // to exp(-6) of the 15 % from which the motion starts.
  ModelOptions options = rigid_study({.disc = source_disc()});
  options.study.analyses = {"limit-cycle"};
  options.study.transient = TransientCase{.speed = 20.0 * pi,
                                          .duration = 10.0,
                                          .initial_pad_displacement = 1.2e-3,
                                          .steps_per_period = 32};
  const LimitCycle cycle = of_study(options).limit_cycle.value();
  EXPECT_NEAR(cycle.frequency_Hz, 1740.888105, 2e-3);
  EXPECT_NEAR(cycle.pad_velocity, 11.52144, 0.01);
  EXPECT_NEAR(cycle.pad_displacement, 1.053665e-3, 1e-6);
  options.model = RigidDiscStudy{.disc = source_disc(), .equations = RigidEquations::linear};
  options.study.transient->duration = 2.0;
  const Transient linear = of_study(options).transient.value();
  // exp(0.49 t) over the last second.
  EXPECT_GT(linear.envelope.pad_velocity.back(), 1.3 * cycle.pad_velocity);
}

TEST(RigidModel, LosesItsSpinToTheFrictionOfLargeMotionsWhenTheMomentIsConstant)
{
  ModelOptions options = rigid_study({.disc = source_disc(), .drive = Drive::moment});
  const RigidDiscBrake model(
      {.disc = source_disc(), .drive = Drive::moment, .equations = RigidEquations::nonlinear});
  ASSERT_EQ(model.size(), 5);
  EXPECT_EQ(model.rate(model.start(0.0), 6.0 * pi)[4], 0.0);
  // Half a millimetre is beyond N_0 / k: one pad loses its force, the other one gains as much, and
  // |N| in the friction law makes the sum larger than the drive allows for.
  EXPECT_LT(model.rate(model.start(1e-3), 6.0 * pi)[4], -1.0);
}

/// Undamped, with equal frequencies of 500 Hz without friction and coupling.
Oscillator belt()
{
  return {.mass = 1.0,
          .k_x = 1.2e7,
          .k_y = 4e6,
          .k_xy = 1e6,
          .d_x = 0.0,
          .d_y = 0.0,
          .contact_stiffness = 7e6,
          .preload = 500.0,
          .radius = 0.13,
          .friction = {0.0}};
}

double growth_at(const Oscillator& oscillator, double speed)
{
  return least_stable_eigenvalue(SlidingBrake(oscillator).state_matrix(speed)).real();
}

TEST(Oscillator, FluttersWhereItsTwoFrequenciesMeet)
{
  // Closed form: the discriminant of the 2 x 2 eigenvalue problem vanishes. Beside it eigenvalues
  // go with the root of the distance: omega sqrt(1e-6 / 4) is 2.
  Oscillator o = belt();
  const double critical = flutter_friction(o);
  EXPECT_NEAR(critical, (0.25e12 + 1e12) / 7e12, 1e-15);
  o.friction.kinetic = critical * (1.0 - 1e-6);
  EXPECT_LT(growth_at(o, 10.0), 1e-6);
  o.friction.kinetic = critical * (1.0 + 1e-6);
  EXPECT_GT(growth_at(o, 10.0), 0.05);
  EXPECT_NEAR(growth_at(o, 10.0), growth_at(o, 50.0), 1e-3);  // at any speed: Coulomb friction
}

TEST(Oscillator, IsUnstableOnTheFallingSlopeWithoutAnyCoupling)
{
  // Without coupling, x alone: lambda = -(d_x + N_0 mu'(V)) / (2 m) + i ...
  Oscillator o = belt();
  o.k_xy = 0.0;
  o.d_x = 20.0;
  o.friction = {.kinetic = 0.4, .rise = 0.3, .decay_speed = 0.5};
  for (const double speed : {2.0, 10.0}) {
    const double slope = -0.3 / 0.5 * std::exp(-0.13 * speed / 0.5);
    // Of y, undamped, the growth is zero.
    EXPECT_NEAR(growth_at(o, speed), std::max(0.0, -0.5 * (20.0 + 500.0 * slope)), 1e-8) << speed;
  }
  EXPECT_GT(growth_at(o, 2.0), 1.0);
}

TEST(Oscillator, IsDampedByFrictionThatRisesWithTheSpeed)
{
  // As above, lambda = -(d_x + N_0 mu'(V)) / (2 m) + i ..., now with mu' > 0; y is damped more.
  Oscillator o = belt();
  o.k_xy = 0.0;
  o.d_y = 2000.0;
  o.friction = {.kinetic = 0.4, .rise = -0.3, .decay_speed = 0.5};
  for (const double speed : {2.0, 10.0}) {
    const double slope = 0.3 / 0.5 * std::exp(-0.13 * speed / 0.5);
    EXPECT_NEAR(growth_at(o, speed), -0.5 * 500.0 * slope, 1e-8) << speed;
  }
  EXPECT_LT(growth_at(o, 2.0), -50.0);
}

TEST(RigidModel, IsDampedByFrictionThatRisesWithTheSpeed)
{
  // The slope of mu adds (h^2 / 2) N_0 mu'(v) to one damping constant, over 2 Theta in the rate of
  // both modes together, half their trace; mu itself is the same at this speed.
  RigidDisc rising = source_disc(), constant = source_disc();
  const double v = rising.radius * 8.0;
  rising.friction = {.kinetic = 0.6, .rise = -0.2, .decay_speed = 0.8};
  constant.friction = {.kinetic = friction_coefficient(rising.friction, v)};
  const auto trace = [](const RigidDisc& disc) {
    return RigidDiscBrake({.disc = disc}).state_matrix(8.0).trace();
  };
  const double slope = 0.2 / 0.8 * std::exp(-v / 0.8), h = rising.thickness;
  EXPECT_NEAR(trace(rising) - trace(constant), -0.5 * h * h * rising.preload * slope / rising.Theta,
              1e-9);
  EXPECT_LT(trace(rising), trace(constant));
}

TEST(Oscillator, SticksAndSlipsAtTheSpeedOfTheBelt)
{
  // The mass is carried along by the belt until the spring pulls it off: its largest velocity in
  // the direction of the belt is that of the belt, and its displacement at the end of sticking is
  // where the spring reaches static friction.
  Oscillator o = belt();
  o.k_x = 4e4;
  o.k_xy = 0.0;
  o.mass = 2.0;
  o.d_x = o.d_y = 2.0;
  o.friction = {.kinetic = 0.3, .rise = 0.3, .decay_speed = 0.05, .regularisation = 1e-3};
  const SlidingBrake model(o);
  const double speed = 0.5, V = 0.13 * speed;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
  x[2] = 0.5 * V;
  double fastest = 0.0, farthest = 0.0, slowest_slip = 1.0;
  // mu' N_0 / m at the regularised passage is 0.6 500 / (1e-3 2) = 1.5e5 1/s: step below 1e-5 s.
  const double h = 4e-6;
  for (int i = 0; i < 250000; ++i) {
    const Eigen::VectorXd k_1 = model.rate(x, speed);
    x += h * model.rate(x + 0.5 * h * k_1, speed);
    if (i < 150000) continue;
    fastest = std::max(fastest, x[2]);
    farthest = std::max(farthest, x[0] / std::sqrt(o.k_x / o.mass));
    slowest_slip = std::min(slowest_slip, model.contact(x, speed).upper.slip_speed);
  }
  EXPECT_NEAR(fastest, V, 2e-2 * V);  // creep of the regularisation is below 1e-3 m/s
  EXPECT_LT(slowest_slip, 5e-4);
  const double at_rest = o.preload * friction_coefficient(o.friction, V) / o.k_x;
  // The creep before the break loses exp(-1e-3 / 0.05), 2 % of the rise, and more while it speeds
  // up.
  const double breakaway = o.preload * 0.6 / o.k_x;
  EXPECT_GT(at_rest + farthest, 0.95 * breakaway);
  EXPECT_LT(at_rest + farthest, breakaway);
}

TEST(Oscillator, LeavesTheBeltWhenItMay)
{
  Oscillator o = belt();
  o.friction.kinetic = 0.6;
  const SlidingBrake model(o);
  const Eigen::VectorXd off = model.start(-2.0 * model.rest_compression());
  EXPECT_EQ(model.contact(off, 10.0).upper.N, 0.0);
  EXPECT_EQ(model.contact(off, 10.0).upper.f_t, 0.0);
  o.law = ContactLaw::bilateral;
  EXPECT_LT(SlidingBrake(o).contact(off, 10.0).upper.N, 0.0);
  EXPECT_GT(SlidingBrake(o).contact(off, 10.0).upper.f_t, 0.0);
}

TEST(ModelTransient, HasAnEnvelopeOfFourPeriodsOfItsLowestFrequency)
{
  const RigidDiscBrake model(
      {.disc = source_disc(), .drive = Drive::speed, .equations = RigidEquations::linear});
  const TransientCase run{.speed = 100.0 * pi,  // which splits the frequencies
                          .duration = 0.5,
                          .initial_pad_displacement = 1e-6,
                          .steps_per_period = 40};
  const Eigen::VectorXcd lambda = model.state_matrix(run.speed).eigenvalues();
  const double highest = lambda.cwiseAbs().maxCoeff();
  double lowest = highest;
  for (const std::complex<double>& one : lambda)
    if (one.imag() > 0.0) lowest = std::min(lowest, one.imag());
  ASSERT_GT(highest, 1.02 * lowest);
  // One point of each window of whole steps, and one of what is left.
  EXPECT_NEAR(double(transient(model, run).envelope.t.size()), 0.5 * lowest / (8.0 * pi), 1.5);
}

TEST(ModelTransient, RefusesWhatItCannotIntegrate)
{
  const RigidDiscBrake model(
      {.disc = source_disc(), .drive = Drive::speed, .equations = RigidEquations::nonlinear});
  TransientCase run{.speed = 0.0, .duration = 1.0, .initial_pad_displacement = 1e-6};
  EXPECT_THROW(transient(model, run), Error);
  run.speed = 10.0;
  run.steps_per_period = 4;
  EXPECT_THROW(transient(model, run), Error);
  EXPECT_THROW(growth(model, 10.0, 1e-4), Error);
}

}  // namespace
}  // namespace chladni::squeal
