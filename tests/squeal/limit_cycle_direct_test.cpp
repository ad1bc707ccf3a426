#include "squeal/cycle/limit_cycle_direct.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <string>

#include "common/error.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

Disc reference_disc(double f_Hz = 1672.13)
{
  return disc_of({kirchhoff_3(f_Hz)});
}

/// SQUEAL reference values at 6 pi, 1672.13 Hz: shooting with DOP853 at fixed steps across the
/// kinks of the contact law, which leave it 1e-5 (unilateral) and less.
struct DirectReference {
  ContactLaw law;
  double frequency_Hz, velocity, displacement, N_min, N_max, slip_speed_min;
  double multiplier;  ///< the largest but the one along the cycle
};
const DirectReference direct_references[] = {
    {ContactLaw::bilateral, 1696.8532997475254, 6.727395672604715, 0.0006309367316120831,
     -1783.0913562400988, 5793.708263785931, 1.883089309387372, 0.9980871398726203},
    {ContactLaw::unilateral, 1691.1221391516015, 12.16940760227354, 0.0011440526826268218, 0.0,
     8896.455713821026, 1.1115357744807817, 0.9977713180855398},
    {ContactLaw::signed_force, 1696.8746237948594, 27.165229566368815, 0.0025470598553203874,
     -13205.6965400223, 17764.177528531618, 0.16710218381735786, 0.997264347654194}};

TEST(DirectLimitCycle, IsThatOfTheReferenceForEachContactLaw)
{
  for (const DirectReference& reference : direct_references) {
    SCOPED_TRACE(static_cast<int>(reference.law));
    const DirectLimitCycle cycle = limit_cycle_direct(
        FlexibleDisc(reference_disc(), reference_options(reference.law)), 6.0 * pi);
    EXPECT_NEAR(cycle.frequency_Hz, reference.frequency_Hz, 1e-5);
    EXPECT_NEAR(cycle.pad_velocity, reference.velocity, 5e-6 * reference.velocity);
    EXPECT_NEAR(cycle.pad_displacement, reference.displacement, 5e-6 * reference.displacement);
    // The forces of the signed law have peaks narrower than the 128 samples of a period.
    EXPECT_NEAR(cycle.N_min, reference.N_min, 1e-3 * reference.N_max);
    EXPECT_NEAR(cycle.N_max, reference.N_max, 1e-3 * reference.N_max);
    EXPECT_NEAR(cycle.slip_speed_min, reference.slip_speed_min, 0.03);
    EXPECT_EQ(stability_of(cycle), CycleStability::stable);
    EXPECT_EQ(cycle.speed, 6.0 * pi);
    // Differences of 1e-4 gave the multipliers of the reference: 2e-4 at the kinks.
    EXPECT_NEAR(std::abs(cycle.multipliers[1]), reference.multiplier, 3e-4);
  }
}

TEST(DirectLimitCycle, IsThatOfTheReferenceWithSignedForcesAtOtherSpeeds)
{
  // SQUEAL reference velocities with the frequency of Kirchhoff's plate, printed to a thousandth;
  // its fixed steps across the kinks leave 1e-5 besides.
  struct Point {
    double speed, velocity;
  };
  for (const Point& point : {Point{5.0, 19.263}, Point{10.0, 37.215}, Point{20.0, 69.454}}) {
    const DirectLimitCycle cycle =
        limit_cycle_direct(FlexibleDisc(reference_disc(kirchhoff_3().f_Hz),
                                        reference_options(ContactLaw::signed_force)),
                           point.speed * pi);
    EXPECT_NEAR(cycle.pad_velocity, point.velocity, 5e-4 + 1e-5 * point.velocity)
        << point.speed << " pi";
  }
}

TEST(DirectLimitCycle, KeepsADisturbanceAlongItself)
{
  // x' at x_0 is an eigenvector of the monodromy matrix for 1; the tolerance is the one at which
  // the step is taken for small enough. It would be 1e-3 without the search for the kinks.
  for (const DirectReference& reference : direct_references) {
    const auto cycle = limit_cycle_direct(
        FlexibleDisc(reference_disc(), reference_options(reference.law)), 6.0 * pi);
    EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6) << static_cast<int>(reference.law);
  }
}

TEST(DirectLimitCycle, HasMultipliersWhoseProductIsTheLossOfPhaseVolume)
{
  // Without contact loss or sign changes the divergence of the linearised field is nearly constant:
  // product of the multipliers = exp(-T trace) with the trace of the sliding disc; at 4.275 pi the
  // motion is a third of N_0 / k, and the slip speed, by which the radial friction is divided,
  // changes by a tenth: 1e-2 of the mean.
  const Disc disc = reference_disc(kirchhoff_3().f_Hz);
  const auto cycle = limit_cycle_direct(FlexibleDisc(disc, reference_options()), 4.275 * pi);
  const double loss = -std::log(std::abs(cycle.multipliers.prod())) * cycle.frequency_Hz;
  const double slope = kirchhoff_3().U_r;
  const double trace =
      0.5 * 0.6 * 2000.0 * 4e-4 / (0.13 * 4.275 * pi) * slope * slope / kirchhoff_3().mass;
  EXPECT_NEAR(loss, trace, 2e-2 * trace);
}

TEST(DirectLimitCycle, TakesAFiftiethOfTheContactEvaluationsOfATransient)
{
  // Two evaluations for each of the 16 steps per period of "exponential", the cheapest integrator,
  // over the 6 s of the source, in which each law settles.
  const double of_transient = 6.0 * 1672.13 * 16.0 * 2.0;
  for (const ContactLaw law :
       {ContactLaw::bilateral, ContactLaw::unilateral, ContactLaw::signed_force}) {
    const auto cycle =
        limit_cycle_direct(FlexibleDisc(reference_disc(), reference_options(law)), 6.0 * pi);
    EXPECT_LT(double(cycle.n_contact_evaluations), of_transient / 50.0) << static_cast<int>(law);
  }
}

TEST(DirectLimitCycle, IsWhereATransientEnds)
{
  // 120 steps per period leave 1e-5 of the velocity to the splitting. Two pads and damping, of
  // which the reference values know nothing.
  SquealOptions options = reference_options(ContactLaw::unilateral);
  options.pads = {{0.2, 5e6, 3.0, 1500.0}, {1.4, 2e6, 0.0, 900.0}};
  auto body = analytic_body({kirchhoff_3(1672.13)});
  body.C = Eigen::Matrix2d::Identity();
  const Disc disc = disc_on_ring(body, "track", {});
  const auto cycle = limit_cycle_direct(FlexibleDisc(disc, options), 20.0 * pi);
  const LimitCycle end =
      limit_cycle(transient(FlexibleDisc(disc, options), {.speed = 20.0 * pi,
                                                          .duration = 3.0,
                                                          .initial_pad_displacement = 1e-3,
                                                          .steps_per_period = 120}));
  ASSERT_TRUE(end.settled);
  EXPECT_NEAR(cycle.frequency_Hz, end.frequency_Hz, 1e-6 * end.frequency_Hz);
  EXPECT_NEAR(cycle.pad_velocity, end.pad_velocity, 1e-4 * end.pad_velocity);
  EXPECT_NEAR(cycle.pad_displacement, end.pad_displacement, 1e-4 * end.pad_displacement);
  ASSERT_EQ(cycle.amplitude.size(), 2);
  // Both are turned so that the largest is real; the beat that is left of the transient is 1e-4.
  EXPECT_LT((cycle.amplitude - end.amplitude).norm(), 1e-3 * end.amplitude.norm());
  EXPECT_EQ(cycle.mode_numbers, disc.mode_numbers);
}

TEST(DirectLimitCycle, TakesModesThatTakeNoPart)
{
  // The (2,0) and (4,0) pairs move with the contact only; the cycle shifts by their compliance.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3(1672.13), kirchhoff_4()});
  SquealOptions options = reference_options();
  const auto cycle = limit_cycle_direct(FlexibleDisc(disc, options), 6.0 * pi);
  EXPECT_EQ(cycle.multipliers.size(), 12);
  EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
}

TEST(DirectLimitCycle, RefusesAStableDisc)
{
  EXPECT_THROW(limit_cycle_direct(FlexibleDisc(reference_disc(), reference_options()), 4.2 * pi),
               Error);
}

TEST(DirectLimitCycle, IsNotTheStateOfRest)
{
  // At 4.2 pi Newton's method finds rest only, which is no cycle.
  const auto start =
      limit_cycle_direct(FlexibleDisc(reference_disc(), reference_options()), 4.3 * pi);
  EXPECT_FALSE(limit_cycle_near(FlexibleDisc(reference_disc(), reference_options()), 4.2 * pi,
                                {start.x, 1.0 / start.frequency_Hz}));
}

SquealOptions two_pads_apart(ContactLaw law, double angle)
{
  SquealOptions options = reference_options(law);
  options.pads.push_back(options.pads.front());
  options.pads.back().angle = angle;
  return options;
}

TEST(DirectLimitCycle, ExistsBetweenTwoPadPairsWithEachContactLaw)
{
  // at 60 degrees, 20 pi and with signed forces the first pad moves by more than 50 compressions.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()});
  for (const ContactLaw law :
       {ContactLaw::bilateral, ContactLaw::unilateral, ContactLaw::signed_force}) {
    for (const double angle : {0.3, pi / 3.0, 1.2, pi}) {
      const FlexibleDisc brake(disc, two_pads_apart(law, angle));
      for (const double by_pi : {6.5, 12.0, 20.0}) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(law) << ", " << angle << " rad, " << by_pi << " pi");
        const DirectLimitCycle cycle = limit_cycle_direct(brake, by_pi * pi);
        EXPECT_GT(cycle.pad_velocity, 1.0);
        EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-5);
        EXPECT_EQ(cycle.way, "from the eigenvector");
      }
    }
  }
}

TEST(DirectLimitCycle, IsTheSameByEachDetour)
{
  const FlexibleDisc brake(reference_disc(), two_pads_apart(ContactLaw::unilateral, 0.3));
  const DirectLimitCycle cycle = limit_cycle_direct(brake, 8.0 * pi);
  const Detour branch = cycle_by_continuation(brake, 8.0 * pi),
               transient = cycle_by_transient(brake, 8.0 * pi);
  ASSERT_TRUE(branch.cycle) << branch.said;
  ASSERT_TRUE(transient.cycle) << transient.said;
  for (const Detour& detour : {branch, transient}) {
    EXPECT_NEAR(detour.cycle->pad_velocity, cycle.pad_velocity, 1e-5 * cycle.pad_velocity)
        << detour.said;
    EXPECT_NEAR(detour.cycle->frequency_Hz, cycle.frequency_Hz, 1e-6 * cycle.frequency_Hz)
        << detour.said;
  }
  EXPECT_NE(branch.said.find("Hopf point"), std::string::npos) << branch.said;
  EXPECT_NE(transient.said.find("periods"), std::string::npos) << transient.said;
}

TEST(DirectLimitCycle, HasOnePeriodAfterATransientToo)
{
  // With bilateral contact cycles are faster than their eigenvectors, and two of their periods are
  // among those that are looked at.
  for (const ContactLaw law : {ContactLaw::bilateral, ContactLaw::unilateral}) {
    const FlexibleDisc brake(reference_disc(), reference_options(law));
    for (const double by_pi : {5.0, 6.0, 7.0, 9.0}) {
      const Detour end = cycle_by_transient(brake, by_pi * pi);
      ASSERT_TRUE(end.cycle) << end.said;
      const DirectLimitCycle cycle = limit_cycle_direct(brake, by_pi * pi);
      EXPECT_NEAR(end.cycle->frequency_Hz, cycle.frequency_Hz, 1e-6 * cycle.frequency_Hz)
          << static_cast<int>(law) << ", " << by_pi << " pi";
    }
  }
}

TEST(DirectLimitCycle, SaysWhyADetourLeadsNowhere)
{
  // With one sinusoidal mode pair and two pads the brake is unstable only above 4.24 pi.
  const FlexibleDisc stable(reference_disc(), two_pads_apart(ContactLaw::unilateral, 0.3));
  const Detour branch = cycle_by_continuation(stable, 3.0 * pi);
  EXPECT_FALSE(branch.cycle);
  EXPECT_NE(branch.said.find("no Hopf point"), std::string::npos) << branch.said;
}

}  // namespace
}  // namespace chladni::squeal
