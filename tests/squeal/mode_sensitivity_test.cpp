#include "squeal/stability/sensitivity.hpp"

#include <gtest/gtest.h>

#include "common/error.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TEST(ModeSensitivity, SaysWhichModesMoveTheCriticalSpeed)
{
  // The pair (3,0) alone against (3,0) among its neighbours (2,0) and (4,0), made stable by
  // damping.
  auto body = analytic_body({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()});
  body.C = Eigen::MatrixXd::Zero(6, 6);
  for (const int i : {0, 1, 4, 5}) body.C(i, i) = 200.0;
  const InertialDisc disc = inertial_disc(disc_on_ring(body, "track", {}));
  const SquealOptions options = reference_options();
  const ModeSensitivity result = mode_sensitivity(disc, options);
  EXPECT_EQ(
      result.critical_speed,
      critical_speed(stability_over_speed(at_speeds(disc, options), options.study.speeds))->speed);
  ASSERT_EQ(result.influences.size(), 3u);
  EXPECT_GT(result.influences[1].participation, 0.9);
  EXPECT_EQ(result.influences[1].nodal_diameters, 3);
  EXPECT_FALSE(result.influences[1].growth_without);
  EXPECT_NEAR(result.influences[0].participation + result.influences[1].participation +
                  result.influences[2].participation,
              1.0, 1e-12);
  // Leaving a pair out is what computing without it gives.
  auto without = analytic_body({kirchhoff_3(), kirchhoff_4()});
  without.C = body.C.bottomRightCorner(4, 4);
  const auto expected =
      critical_speed(stability_over_speed(
                         at_speeds(inertial_disc(disc_on_ring(without, "track", {})), options),
                         options.study.speeds))
          ->speed;
  EXPECT_NEAR(result.influences[0].critical_speed_without.value(), expected, 1e-7 * expected);
  EXPECT_NE(result.influences[0].growth_without.value(), 0.0);
}

TEST(ModeSensitivity, ComparesTheLowestTwoEightSixteenAndAllModes)
{
  // With the (1,0) pair at 584 Hz alone and with all 35 modes (SQUEAL reference value).
  SquealOptions options = reference_options();
  options.study.speeds.from = 0.2 * pi;
  const InertialDisc disc = inertial_disc(disc_of(kirchhoff_modes()));
  const ModeSensitivity result = mode_sensitivity(disc, options);
  ASSERT_EQ(result.subsets.size(), 4u);
  EXPECT_EQ(result.subsets[0].n_modes, 2);
  EXPECT_GE(result.subsets[1].n_modes, 8);
  EXPECT_LE(result.subsets[1].n_modes, 9);
  EXPECT_EQ(result.subsets[3].n_modes, 35);
  EXPECT_NEAR(result.subsets[3].critical_speed.value() / pi, 4.028040537151143, 1e-8);
  EXPECT_NEAR(result.critical_speed / pi, 4.028040537151143, 1e-8);
  EXPECT_NEAR(result.subsets[3].growth, 0.0, 1e-7);
  ASSERT_EQ(result.influences.size(), 19u);
  EXPECT_GT(result.influences[0].participation, 0.5);
}

TEST(ModeSensitivity, NeedsACriticalSpeedInTheRange)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = pi, .to = 2.0 * pi, .count = 10};
  EXPECT_THROW(mode_sensitivity(inertial_disc(disc_of({kirchhoff_3()})), options), Error);
}

TEST(Coriolis, OfTheRotaryInertiaRaisesTheCriticalSpeedOfAMindlinPlate)
{
  // SQUEAL reference values: 4 I / (2 n m) = -0.0076588 of the coupling 2 n Omega, and the critical
  // speed of the Mindlin pair with it. They leave out the centrifugal part 2 n g Omega^2 of the
  // same terms, 1e-7 of omega^2.
  auto body = analytic_body({mindlin_3()});
  Disc disc = disc_on_ring(body, "track", {});
  const double g = 3.0 * 0.00765875649913187;
  const auto critical_by_pi = [&] {
    return critical_speed(stability_over_speed(at_speeds(inertial_disc(disc), reference_options()),
                                               reference_options().study.speeds))
               ->speed /
           pi;
  };
  EXPECT_NEAR(critical_by_pi(), 4.235183338216228, 1e-9);
  // As a body has them: 2 int phi_i . (e_z x phi_j) dm = 2 (S_xy^T - S_xy).
  mbs_export::MassIntegrals integrals{};
  integrals.displacement = Eigen::MatrixXd::Zero(3, 2);
  integrals.products.fill(Eigen::Matrix2d::Zero());
  integrals.products[3] = Eigen::Matrix2d{{0.0, g}, {0.0, 0.0}};
  body.mass_integrals = integrals;
  disc = disc_on_ring(body, "track", {});
  EXPECT_EQ(disc.G, (Eigen::Matrix2d{{0.0, -g}, {g, 0.0}}));
  EXPECT_NEAR(critical_by_pi(), 4.250189346231441, 1e-7);
  // The transient has the same terms in its kick.
  const Growth result = growth(FlexibleDisc(disc, reference_options()), 6.0 * pi, 3.0);
  EXPECT_NEAR(*result.eigenvalue_rate, 2.6557811006225065, 1e-6);
  TransientCase run{.speed = 6.0 * pi,
                    .duration = 3.0,
                    .initial_pad_displacement = 3e-8,
                    .steps_per_period = 40,
                    .integrator = IntegratorKind::splitting};
  EXPECT_NEAR(transient(FlexibleDisc(disc, reference_options()), run).growth_rate.value(),
              2.6557811, 5e-4);
}

}  // namespace
}  // namespace chladni::squeal
