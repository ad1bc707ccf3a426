#include "squeal/stability/rotation_stability.hpp"

#include <gtest/gtest.h>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// The reference pair with the two frequencies `split_Hz` apart, as a mesh may leave them.
Disc split_disc(double split_Hz, double turn = 0.3)
{
  PlatePair pair = kirchhoff_3();
  pair.f_Hz -= 0.5 * split_Hz;
  pair.split = split_Hz / pair.f_Hz;
  pair.turn = turn;
  return disc_of({pair});
}

TEST(RotationStability, IsThatOfTheEigenvaluesOnAnAxisymmetricDisc)
{
  // The disc in its own frame against the inertial frame; the extrapolation leaves 1e-5 1/s.
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  for (const double speed : {4.0 * pi, 6.0 * pi, 12.0 * pi}) {
    const auto lambda =
        least_stable_eigenvalue(state_matrix(inertial_disc(disc), reference_options(), speed));
    const RotationGrowth at = rotation_growth(disc, reference_options(), speed);
    EXPECT_NEAR(at.growth, lambda.real(), 3e-5);
    EXPECT_NEAR(at.frequency_Hz, lambda.imag() / (2.0 * pi), 2.0 * 3.0 * speed / (2.0 * pi));
  }
}

TEST(RotationStability, IsThatOfTheEigenvaluesWithCoriolisForcesToo)
{
  const Disc disc = disc_with_coriolis(0.0);
  ASSERT_GT(disc.G.cwiseAbs().maxCoeff(), 0.1);
  for (const double speed : {4.0 * pi, 12.0 * pi}) {
    const auto lambda =
        least_stable_eigenvalue(state_matrix(inertial_disc(disc), reference_options(), speed));
    EXPECT_NEAR(rotation_growth(disc, reference_options(), speed).growth, lambda.real(), 3e-5);
  }
}

TEST(RotationStability, OfASplitPairIsThatOfTheReference)
{
  // SQUEAL reference values with four digits: growth at 6 pi over the split of the pair, in Hz.
  const double references[][2] = {{0.0, 2.689}, {1.0, 2.681}, {3.0, 2.619}, {10.0, 2.265}};
  for (const auto& [split_Hz, growth] : references) {
    EXPECT_NEAR(rotation_growth(split_disc(split_Hz), reference_options(), 6.0 * pi).growth, growth,
                1e-3)
        << split_Hz;
  }
}

TEST(RotationStability, IsWhatATransientDoes)
{
  // 60 Hz of split, 3 %: beyond what has eigenvalues. The fit to an envelope that beats with the
  // rotation leaves a few per cent.
  const Disc disc = split_disc(60.0);
  ASSERT_FALSE(find_inertial_disc(disc));
  SquealOptions options = reference_options();
  const double speed = 16.0 * pi;
  const Growth simulated = growth(FlexibleDisc(disc, options), speed, 2.0);
  const double expected = rotation_growth(disc, options, speed).growth;
  EXPECT_NEAR(simulated.rate, expected, 0.05 * std::abs(expected));
}

TEST(RotationStability, FindsTheCriticalSpeedWithAnyNumberOfThreads)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 4.0 * pi, .to = 5.0 * pi, .count = 5};
  const Disc disc = split_disc(0.0);
  const RotationStability one = rotation_stability(disc, options, 1);
  // The growth rate rises by 2 1/s for each pi; its error is 1e-5 1/s.
  ASSERT_TRUE(one.critical_speed);
  EXPECT_NEAR(*one.critical_speed / pi, 4.2718984074, 1e-5);
  const RotationStability two = rotation_stability(disc, options, 2);
  EXPECT_EQ(one.growth, two.growth);
  EXPECT_EQ(*one.critical_speed, *two.critical_speed);
}

TEST(RotationStability, TakesModesWithoutInertia)
{
  // Modes of four diameters as compliance alone, against the eigenvalues.
  const mbs_export::ModalBody body = analytic_body({kirchhoff_2(), kirchhoff_3(), kirchhoff_4()});
  const Disc disc = disc_on_ring(body, "track", {.quasi_static_above = 2.0 * pi * 2500.0});
  ASSERT_EQ(disc.n_modes(), 4);
  ASSERT_FALSE(disc.compliance.empty());
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 6.0 * pi, .to = 6.0 * pi, .count = 1};
  const double growth =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc), options, options.study.speeds.from))
          .real();
  EXPECT_NEAR(rotation_stability(disc, options).growth[0], growth, 1e-9);
  options.study.rotation_method = RotationMethod::floquet;
  EXPECT_NEAR(rotation_stability(disc, options).growth[0], growth, 3e-5);
}

TEST(RotationStability, ByHillIsThatByFloquet)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 4.0 * pi, .to = 9.0 * pi, .count = 6};
  const Disc disc = split_disc(10.0);
  const RotationStability hill = rotation_stability(disc, options);
  options.study.rotation_method = RotationMethod::floquet;
  const RotationStability floquet = rotation_stability(disc, options);
  EXPECT_EQ(hill.method, "hill");
  EXPECT_EQ(floquet.method, "floquet");
  EXPECT_LT((hill.growth - floquet.growth).cwiseAbs().maxCoeff(), 1e-4);
  ASSERT_TRUE(hill.critical_speed && floquet.critical_speed);
  EXPECT_NEAR(*hill.critical_speed, *floquet.critical_speed, 1e-4);
  EXPECT_EQ(hill.exponents.real().col(0), hill.growth);
  EXPECT_EQ(floquet.exponents.size(), 0);
  EXPECT_EQ(hill.frozen_growth, floquet.frozen_growth);
  // A standing disc seems to squeal already where the turning one is stable.
  EXPECT_LT(hill.growth[0], 0.0);
  EXPECT_GT(hill.frozen_growth[0], 0.0);
}

TEST(RotationStability, SaysThatItIsLostNowhereWhereAllSpeedsAreUnstable)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 8.0 * pi, .to = 9.0 * pi, .count = 3};
  const RotationStability stability = rotation_stability(split_disc(10.0), options);
  EXPECT_FALSE(stability.critical_speed);
  EXPECT_EQ(stability_of(stability), Stability::unstable);
}

}  // namespace
}  // namespace chladni::squeal
