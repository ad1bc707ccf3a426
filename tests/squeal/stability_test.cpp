#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalues.hpp"

#include <gtest/gtest.h>

#include "squeal/stability/stability_search.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/references/squeal/kirchhoff_modes.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

InertialDisc inertial_of(const std::vector<PlatePair>& pairs)
{
  return inertial_disc(disc_of(pairs));
}

/// x = (diag(omega) a, p) of the state matrix back in M a'' + C a' + K a = 0 of the plate.
struct DiscSecondOrder {
  Eigen::MatrixXd C, K;
};

DiscSecondOrder second_order_of_disc(const Eigen::MatrixXd& A, const InertialDisc& disc,
                                     double mass)
{
  const Eigen::Index n = disc.n_modes();
  const Eigen::MatrixXd omega = disc.omega.asDiagonal();
  const Eigen::MatrixXd G = A.topLeftCorner(n, n), P = A.bottomRightCorner(n, n);
  // p = a' - G a (G commutes with the omega of a pair); p' = B omega a + P p.
  const Eigen::MatrixXd B = A.bottomLeftCorner(n, n) * omega;
  return {-mass * (G + P), mass * (P * G - B)};
}

void expect_matrix(const Eigen::MatrixXd& actual, const Eigen::Matrix2d& expected, double tolerance)
{
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      EXPECT_NEAR(actual(i, j), expected(i, j), tolerance) << i << ", " << j;
}

/// All plate modes with the modal damping ratio `zeta`.
InertialDisc damped_plate(double zeta)
{
  auto body = analytic_body(kirchhoff_modes());
  body.C = (2.0 * zeta * body.omega).asDiagonal();
  return inertial_disc(disc_on_ring(body, "track", {}));
}

TEST(StateMatrix, HasTheReferenceMatricesOfOnePair)
{
  // SQUEAL reference values: the closed form of section 2.4 with (beta, chi) = (1, 0). Tolerance:
  // rounding of K = 2e8 N/m, relative 1e-12 of the largest entry.
  const InertialDisc disc = inertial_of({kirchhoff_3()});
  const Eigen::MatrixXd A = state_matrix(disc, reference_options(), 6.0 * pi);
  const DiscSecondOrder plate = second_order_of_disc(A, disc, kirchhoff_3().mass);
  // Our pair may be turned by half a period: both signs change, the matrices do not.
  expect_matrix(
      plate.C,
      Eigen::Matrix2d{{11.695551808139149, 181.37948520486285}, {-181.37948520486285, 0.0}}, 1e-9);
  expect_matrix(plate.K,
                Eigen::Matrix2d{{198406359.806322, 661.3678735223178},
                                {-632096.2250733384, 193847465.02221137}},
                2e-4);
}

TEST(StateMatrix, SplitsTheFrequenciesOfAFreeRotatingDiscByNTimesTheSpeed)
{
  SquealOptions no_pads = reference_options();
  no_pads.pads.clear();
  const InertialDisc disc = inertial_of({kirchhoff_2()});
  const Eigen::VectorXcd lambda = state_matrix(disc, no_pads, 30.0).eigenvalues();
  const double omega = 2.0 * pi * kirchhoff_2().f_Hz;
  std::vector<double> im(4);
  for (int i = 0; i < 4; ++i) im[static_cast<std::size_t>(i)] = lambda[i].imag();
  std::ranges::sort(im);
  EXPECT_NEAR(im[2], omega - 60.0, 1e-9);  // rounding of 5e3
  EXPECT_NEAR(im[3], omega + 60.0, 1e-9);
  EXPECT_LT(lambda.real().cwiseAbs().maxCoeff(), 1e-10);
}

TEST(StateMatrix, AddsPadsThatSeeTheSameMotion)
{
  // Three nodal diameters repeat every 120 degrees: two pads there are one of twice the strength.
  SquealOptions two = reference_options(), one = reference_options();
  two.pads = {{0.3, 6e6, 20.0, 2000.0}, {0.3 + 2.0 * pi / 3.0, 6e6, 20.0, 2000.0}};
  one.pads = {{0.3, 12e6, 40.0, 4000.0}};
  const InertialDisc disc = inertial_of({kirchhoff_3()});
  const Eigen::MatrixXd A = state_matrix(disc, two, 20.0), B = state_matrix(disc, one, 20.0);
  EXPECT_LT((A - B).norm(), 1e-13 * B.norm());
}

TEST(LeastStableEigenvalue, IsThatOfTheReference)
{
  // SQUEAL reference values; rounding of an eigenvalue of 1e4: 1e-11, with a margin of 100.
  const struct {
    double f_Hz, speed_by_pi, growth, omega;
  } references[] = {{1749.7487734358904, 1.0, -1.3767159027745908, 10993.839721502281},
                    {1749.7487734358904, 4.2, -0.14885993133037817, 11134.041516128418},
                    {1749.7487734358904, 20.0, 7.702965050554597, 11257.893637671124},
                    {1672.13, 3.8, -1.0360069717642382, 10649.961103576345},
                    {1672.13, 6.0, 2.775972925130693, 10661.774219648141}};
  for (const auto& reference : references) {
    const auto lambda =
        least_stable_eigenvalue(state_matrix(inertial_of({kirchhoff_3(reference.f_Hz)}),
                                             reference_options(), reference.speed_by_pi * pi));
    EXPECT_NEAR(lambda.real(), reference.growth, 1e-9) << reference.speed_by_pi;
    EXPECT_NEAR(lambda.imag(), reference.omega, 1e-9 * reference.omega);
  }
}

TEST(CriticalSpeed, IsThatOfTheKirchhoffPlate)
{
  // SQUEAL reference values, Newton on det(-omega^2 M + i omega C + K) = 0. The growth rate is
  // known to 1e-11 and changes by 0.65 per unit of speed: 2e-11 rad/s, 1e-12 relative; margin
  // of 10.
  const struct {
    double f_Hz, speed_by_pi, frequency;
  } references[] = {{1749.7487734358904, 4.271898407362968, 1772.0954575721983},
                    {1672.13, 4.2567454955104145, 1695.3360061473277}};
  for (const auto& reference : references) {
    const auto critical = critical_speed(stability_over_speed(
        at_speeds(inertial_of({kirchhoff_3(reference.f_Hz)}), reference_options()),
        reference_options().study.speeds));
    ASSERT_TRUE(critical);
    EXPECT_NEAR(critical->speed / pi, reference.speed_by_pi, 1e-11 * reference.speed_by_pi);
    EXPECT_NEAR(critical->frequency_Hz, reference.frequency, 1e-10 * reference.frequency);
  }
}

TEST(CriticalSpeed, OfAMindlinPlateTakesTheSlopesOfItsDirector)
{
  // SQUEAL reference value, Mindlin data without rotary Coriolis terms.
  const auto critical = critical_speed(
      stability_over_speed(at_speeds(inertial_of({mindlin_3()}), reference_options()),
                           reference_options().study.speeds));
  ASSERT_TRUE(critical);
  EXPECT_NEAR(critical->speed / pi, 4.235183338216228, 1e-10);
}

TEST(CriticalSpeed, OfAllModesIsThatOfTheLowestPairAndRisesWithDamping)
{
  // SQUEAL reference values, 35 modes below 14.3 hz. Undamped, the (1,0) pair comes first; weak
  // growth below 0.157 pi is not a crossing from stable to unstable. Tolerance: the modal data of
  // both sides agree to 1e-14, growth rates to 1e-10 with a slope of about 0.05.
  const struct {
    double zeta, speed_by_pi;
  } references[] = {{0.0, 4.028040537151143},
                    {1e-4, 5.036675776864464},
                    {5e-4, 9.172464690136207},
                    {1e-3, 13.424694341511053}};
  SquealOptions options = reference_options();
  options.study.speeds.from = 0.1 * pi;
  for (const auto& reference : references) {
    const auto critical = critical_speed(stability_over_speed(
        at_speeds(damped_plate(reference.zeta), options), options.study.speeds));
    ASSERT_TRUE(critical);
    EXPECT_NEAR(critical->speed / pi, reference.speed_by_pi, 1e-8) << "zeta " << reference.zeta;
  }
}

TEST(CriticalSpeed, IsAbsentWhenTheRangeHoldsNone)
{
  const InertialDisc disc = inertial_of({kirchhoff_3()});
  SquealOptions options = reference_options();
  options.study.speeds = {.from = pi, .to = 4.2 * pi, .count = 10};
  EXPECT_FALSE(
      critical_speed(stability_over_speed(at_speeds(disc, options), options.study.speeds)));
  options.study.speeds = {.from = 4.3 * pi, .to = 8.0 * pi, .count = 10};  // unstable throughout
  EXPECT_FALSE(
      critical_speed(stability_over_speed(at_speeds(disc, options), options.study.speeds)));
  options.study.speeds = {.from = pi, .to = 20.0 * pi, .count = 10};
  options.friction.kinetic = 0.0;  // a conservative system: only rounding could cross
  EXPECT_FALSE(
      critical_speed(stability_over_speed(at_speeds(disc, options), options.study.speeds)));
}

TEST(CriticalSpeed, ComesWithTheUnstableIntervalBelowIt)
{
  // The weak growth below 0.157 pi.
  SquealOptions options = reference_options();
  options.study.speeds.from = 0.1 * pi;
  const InertialDisc disc = damped_plate(0.0);
  const StabilityProfile profile =
      stability_over_speed(at_speeds(disc, options), options.study.speeds);
  ASSERT_EQ(profile.unstable.size(), 2u);
  EXPECT_EQ(profile.unstable[0].from.value, 0.1 * pi);
  EXPECT_GT(profile.unstable[0].from.growth, 0.0);
  const double regained = profile.unstable[0].to.value;
  EXPECT_NEAR(regained / pi, 0.157, 0.001);
  EXPECT_GT(least_stable_eigenvalue(state_matrix(disc, options, regained * (1.0 - 1e-4))).real(),
            1e-7);
  EXPECT_LT(least_stable_eigenvalue(state_matrix(disc, options, regained * (1.0 + 1e-4))).real(),
            -1e-7);
  EXPECT_NEAR(profile.unstable[1].from.value / pi, 4.028040537151143, 1e-8);
  EXPECT_EQ(profile.unstable[1].to.value, 20.0 * pi);
  EXPECT_EQ(stability_of(profile), Stability::lost);
}

TEST(CriticalSpeed, TellsWhyThereIsNone)
{
  const auto stability = [](double from, double to, double friction) {
    SquealOptions options = reference_options();
    options.study.speeds = {.from = from * pi, .to = to * pi, .count = 10};
    options.friction.kinetic = friction;
    return stability_of(stability_over_speed(at_speeds(inertial_of({kirchhoff_3()}), options),
                                             options.study.speeds));
  };
  EXPECT_EQ(stability(1.0, 4.2, 0.6), Stability::stable);
  EXPECT_EQ(stability(4.3, 8.0, 0.6), Stability::unstable);
  EXPECT_EQ(stability(4.0, 8.0, 0.6), Stability::lost);
  EXPECT_EQ(stability(1.0, 20.0, 0.0), Stability::stable);  // conservative
}

TEST(CriticalSpeed, DoesNotDependOnTheOrientationOfTheEigenvectors)
{
  PlatePair turned = kirchhoff_3();
  turned.turn = 1.1;
  turned.sign = -1.0;
  SquealOptions options = reference_options();
  const auto reference = critical_speed(
      stability_over_speed(at_speeds(inertial_of({kirchhoff_3()}), options), options.study.speeds));
  options.pads[0].angle = 0.77;  // nor on the place of the pad
  const auto critical = critical_speed(
      stability_over_speed(at_speeds(inertial_of({turned}), options), options.study.speeds));
  EXPECT_NEAR(critical->speed, reference->speed, 1e-11 * reference->speed);
}

TEST(Eigenvalues, AreFollowedThroughACrossing)
{
  // The forward wave of (5,0) at 13.5 hz overtakes the backward wave of (2,2) near 34 pi. Branches
  // ordered by frequency would bend there by 7 times the step of the speed, 10 rad/s. The pads are
  // too weak to couple the two waves, which would turn the crossing into a veering.
  SquealOptions options = reference_options();
  options.pads[0].stiffness = 6e3;
  options.pads[0].preload = 2.0;
  options.study.speeds = {.from = 8.0 * pi, .to = 60.0 * pi, .count = 113};
  const InertialDisc disc = damped_plate(1e-4);
  const EigenvalueMap map = eigenvalues(at_speeds(disc, options), options.study.speeds);
  ASSERT_EQ(map.lambda.rows(), 113);
  ASSERT_EQ(map.lambda.cols(), 35);
  double bend = 0.0;
  for (Eigen::Index i = 2; i < 113; ++i) {
    bend = std::max(bend, (map.lambda.row(i) - 2.0 * map.lambda.row(i - 1) + map.lambda.row(i - 2))
                              .cwiseAbs()
                              .maxCoeff());
  }
  EXPECT_LT(bend, 0.1);
  EXPECT_NEAR(map.lambda.row(60).real().maxCoeff(),
              least_stable_eigenvalue(state_matrix(disc, options, map.speeds[60])).real(), 1e-8);
}

TEST(Eigenvalues, KeepTheOscillatingOneNextToAnOverdampedPair)
{
  // SQUEAL reference values: at 0.001 pi one mode is overdamped, with real eigenvalues -3038 and
  // -40717. They are ill-conditioned, hence 1e-8 relative.
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 0.001 * pi, .to = 0.001 * pi, .count = 1};
  const EigenvalueMap map =
      eigenvalues(at_speeds(inertial_of({kirchhoff_3()}), options), options.study.speeds);
  EXPECT_NEAR(map.lambda(0, 0).real(), -3038.4412250221476, 1e-8 * 3038.0);
  EXPECT_EQ(map.lambda(0, 0).imag(), 0.0);
  EXPECT_NEAR(map.lambda(0, 1).imag(), 10994.308328271345, 1e-8 * 1e4);
}

}  // namespace
}  // namespace chladni::squeal
