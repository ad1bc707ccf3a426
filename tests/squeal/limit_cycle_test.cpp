#include "squeal/cycle/limit_cycle.hpp"

#include <gtest/gtest.h>

#include <complex>

#include "common/error.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TransientCase reference_run(double duration = 7.7, int steps_per_period = 40)
{
  return {.speed = 6.0 * pi,
          .duration = duration,
          .initial_pad_displacement = 6.8e-8,
          .steps_per_period = steps_per_period,
          .integrator = IntegratorKind::splitting};
}

LimitCycle cycle_of(ContactLaw law, const TransientCase& run)
{
  const Disc disc = disc_of({kirchhoff_3(1672.13)});
  return limit_cycle(transient(FlexibleDisc(disc, reference_options(law)), run));
}

/// SQUEAL reference values at 6 pi, 1672.13 Hz: periodic solutions by shooting with DOP853; times
/// from its transients.
struct SteadyReference {
  ContactLaw law;
  double frequency_Hz, velocity, displacement, N_max, t_zero_force, t_99;
};
const SteadyReference steady_references[] = {
    {ContactLaw::bilateral, 1696.8532997475254, 6.727395672604715, 0.0006309367316120831,
     5793.708263785931, 3.096350, 3.930615},
    {ContactLaw::unilateral, 1691.1221391516015, 12.16940760227354, 0.0011440526826268218,
     8896.455713821026, 3.096350, 4.454},
    {ContactLaw::signed_force, 1696.8746237948594, 27.165229566368815, 0.0025470598553203874,
     17764.177528531618, 3.096350, 4.792}};

TEST(LimitCycle, IsThatOfTheReferenceForEachContactLaw)
{
  // The splitting error of 40 steps per period, which falls with the square of the step (next
  // test): frequency 7e-7, velocity 1e-4, displacement 1e-4, relative; tolerances are twice that.
  for (const SteadyReference& reference : steady_references) {
    const LimitCycle cycle = cycle_of(reference.law, reference_run());
    SCOPED_TRACE(static_cast<int>(reference.law));
    EXPECT_TRUE(cycle.settled);
    EXPECT_NEAR(cycle.frequency_Hz, reference.frequency_Hz, 1.4e-6 * reference.frequency_Hz);
    EXPECT_NEAR(cycle.pad_velocity, reference.velocity, 2e-4 * reference.velocity);
    EXPECT_NEAR(cycle.pad_displacement, reference.displacement, 2e-4 * reference.displacement);
    EXPECT_NEAR(cycle.N_max, reference.N_max, 5e-4 * reference.N_max);
    // Times: a beat of 27 Hz between the two waves lies on the growth, and the reference tells the
    // first one by its envelope points, 2 ms apart; 99 % is reached at a slope of 0.03 per second.
    EXPECT_NEAR(cycle.t_zero_force.value(), reference.t_zero_force, 3e-3);
    EXPECT_NEAR(cycle.t_99, reference.t_99, 0.015);
  }
}

TEST(LimitCycle, ConvergesWithTheSquareOfTheStep)
{
  const SteadyReference& reference = steady_references[0];
  const auto velocity_error = [&](int steps) {
    return std::abs(cycle_of(reference.law, reference_run(7.7, steps)).pad_velocity -
                    reference.velocity);
  };
  EXPECT_NEAR(velocity_error(20) / velocity_error(40), 4.0, 0.4);
}

TEST(LimitCycle, HasAFundamentalThatMovesThePad)
{
  // The displacement under the pad at angle 0 from the complex amplitudes, against that of the pad:
  // harmonics are below 1e-3 of it, and the pad leaves the surface by h (s - 1) / 2 < 1e-3 of it.
  const Disc disc = disc_of({kirchhoff_3(1672.13)});
  const LimitCycle cycle = cycle_of(ContactLaw::bilateral, reference_run());
  ASSERT_EQ(cycle.amplitude.size(), 2);
  EXPECT_EQ(cycle.mode_numbers, disc.mode_numbers);
  const std::complex<double> at_pad =
      (shapes_at(disc, 0.0).W.cast<std::complex<double>>().transpose() * cycle.amplitude)[0];
  EXPECT_NEAR(std::abs(at_pad), cycle.pad_displacement, 2e-3 * cycle.pad_displacement);
  // SQUEAL reference values at the rim: a wave of 0.701 mm that runs with the disc, cos(n phi -
  // omega t), and one of 0.326 mm against it; printed to three digits.
  const std::complex<double> i(0.0, 1.0), c = cycle.amplitude[0], s = cycle.amplitude[1];
  const double root = std::sqrt(kirchhoff_3().mass);
  EXPECT_NEAR(0.5 * std::abs(c + i * s) / root, 0.701e-3, 0.001e-3);
  EXPECT_NEAR(0.5 * std::abs(c - i * s) / root, 0.326e-3, 0.001e-3);
  EXPECT_NEAR(c.imag(), 0.0, 1e-15 * std::abs(c)) << "the largest amplitude is real";
}

TEST(LimitCycle, TurnsWithTheEigenvectors)
{
  // The same motion of the disc from a body whose eigenvectors are turned by 0.4 rad.
  PlatePair turned = kirchhoff_3(1672.13);
  turned.turn = 0.4;
  turned.sign = -1.0;
  const Disc disc = disc_of({turned});
  const LimitCycle other =
      limit_cycle(transient(FlexibleDisc(disc, reference_options()), reference_run()));
  const LimitCycle cycle = cycle_of(ContactLaw::bilateral, reference_run());
  const auto modulus_at = [](const Disc& of, const LimitCycle& motion, double phi) {
    return std::abs(
        (shapes_at(of, phi).W.cast<std::complex<double>>().transpose() * motion.amplitude)[0]);
  };
  for (const double phi : {0.0, 0.3, 0.7}) {
    EXPECT_NEAR(modulus_at(disc, other, phi),
                modulus_at(disc_of({kirchhoff_3(1672.13)}), cycle, phi), 1e-9);
  }
}

TEST(LimitCycle, SaysWhenItHasNotSettled)
{
  EXPECT_FALSE(cycle_of(ContactLaw::unilateral, reference_run(4.0)).settled);
}

TEST(LimitCycle, RefusesRunsThatCannotHoldOne)
{
  EXPECT_THROW(cycle_of(ContactLaw::bilateral, reference_run(0.004)), Error);
  const Disc disc = disc_of({kirchhoff_3(1672.13)});
  Transient diverged = transient(FlexibleDisc(disc, reference_options()), reference_run(0.1));
  diverged.finished = false;
  EXPECT_THROW(limit_cycle(diverged), Error);
}

}  // namespace
}  // namespace chladni::squeal
