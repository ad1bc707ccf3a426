#include "squeal/pad_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "analytic_body.hpp"
#include "common/error.hpp"
#include "squeal/contact_kick.hpp"
#include "squeal/limit_cycle_direct.hpp"
#include "squeal/sliding_disc.hpp"
#include "squeal/stability.hpp"
#include "squeal/transient.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

Disc pair_disc()
{
  return make_disc(analytic_body({kirchhoff_3()}), "track", {});
}

/// A plate with all six degrees of freedom, 0.3 kg.
PadBody full_body()
{
  return {.mass = 0.3,
          .height = 0.01,
          .radial = Suspension{3e7, 20.0},
          .tangential = Suspension{2e7, 20.0},
          .axial = Suspension{5e6, 30.0},
          .about_radial = RotarySuspension{1.5e-4, {3e3, 0.05}},
          .about_tangential = RotarySuspension{1e-4, {2e3, 0.05}},
          .about_axial = RotarySuspension{2e-4, {2e4, 0.05}}};
}

SquealOptions options_with(const PadPair& pad, ContactLaw law = ContactLaw::bilateral)
{
  SquealOptions options = reference_options(law);
  options.pads = {pad};
  return options;
}

PadPair reference_pad()
{
  return reference_options().pads.front();
}

PadPair grid_pad(double sector, int points)
{
  PadPair pad = reference_pad();
  pad.grid = PadGrid{.sector = sector, .points = points};
  return pad;
}

TEST(PadGrid, SharesStiffnessAndPreloadAmongPointsInTheMiddleOfEqualParts)
{
  const PadSystem pads = pad_system(options_with(grid_pad(0.6, 3)), ring_radius);
  ASSERT_EQ(pads.points.size(), 3u);
  double stiffness = 0.0, preload = 0.0;
  for (const PointPair& point : pads.points) {
    stiffness += point.contact.spring.linear;
    preload += point.contact.preload;
  }
  EXPECT_DOUBLE_EQ(stiffness, 6e6);
  EXPECT_DOUBLE_EQ(preload, 2000.0);
  EXPECT_NEAR(pads.points[0].angle, -0.2, 1e-15);
  EXPECT_NEAR(pads.points[1].angle, 0.0, 1e-15);
  EXPECT_NEAR(pads.points[2].angle, 0.2, 1e-15);
}

TEST(PadGrid, OfOnePointOrNoWidthIsThePadOfOnePoint)
{
  const InertialDisc disc = inertial_disc(pair_disc());
  const Eigen::MatrixXd one = state_matrix(disc, reference_options(), 18.0);
  for (const PadPair& pad : {grid_pad(0.5, 1), grid_pad(1e-9, 7)})
    EXPECT_LT((state_matrix(disc, options_with(pad), 18.0) - one).norm(), 1e-8 * one.norm());
}

TEST(PadGrid, ConvergesToTheIntegralOverTheSector)
{
  // The pad spring on the cosine mode is k times the mean of cos^2(3 phi) over the sector, the
  // midpoint rule converges to it with the square of the spacing.
  const double sector = 0.7;
  const double mean = 0.5 + std::sin(3.0 * sector) / (6.0 * sector);
  const InertialDisc disc = inertial_disc(pair_disc());
  const auto stiffness = [&](int points) {
    SquealOptions options = options_with(grid_pad(sector, points));
    options.friction = 0.0;
    options.pads[0].preload = 1e-9;
    const Eigen::MatrixXd A = state_matrix(disc, options, 18.0);
    return -(A(2, 0) + disc.omega[0]) * disc.omega[0] / (2.0 * 6e6 * disc.U[0] * disc.U[0]);
  };
  const double error = stiffness(8) - mean, finer = stiffness(16) - mean;
  EXPECT_LT(std::abs(error), 0.01);
  EXPECT_NEAR(error / finer, 4.0, 0.1);
}

TEST(PadGrid, LosesContactPointByPoint)
{
  // Tilted so that one end of the face leaves while the other one presses.
  const Disc disc = pair_disc();
  const SquealOptions options = options_with(grid_pad(0.6, 4), ContactLaw::unilateral);
  ContactKick kick(disc, options, 18.0);
  ModalState x{Eigen::Vector2d(0.0, 1.5e-3), Eigen::Vector2d::Zero()};
  const ContactResult<double> pad = kick.apply(x, 0.0, 1e-9).front();
  // w(phi) is odd about the pad; linear springs alone would leave the sum at the preload.
  EXPECT_GT(pad.upper.N, 2100.0);
  EXPECT_GT(pad.lower.N, 2100.0);
}

TEST(PadBody, HasTheFrequenciesOfItsSuspension)
{
  PadPair pad = reference_pad();
  pad.body = PadBody{.mass = 0.5, .axial = Suspension{2e6, 0.0}};
  const PadSystem two = pad_system(options_with(pad), ring_radius);
  EXPECT_NEAR(two.omega[0], 2000.0, 1e-9);
  EXPECT_NEAR(two.omega[1], 2000.0, 1e-9);
  // With a caliper of mass M on k_c: the plates against each other keep theirs, and with
  // each other they are a two-mass chain, omega^2 of [2 k, -2 k; -2 k, 2 k + k_c], diag(2 m, M).
  pad.caliper = Caliper{.mass = 3.0, .axial = {1e6, 0.0}};
  const PadSystem three = pad_system(options_with(pad), ring_radius);
  ASSERT_EQ(three.n_modes(), 3);
  Eigen::Matrix2d K;
  K << 4e6, -4e6, -4e6, 5e6;
  const Eigen::Matrix2d M = Eigen::Vector2d{1.0, 3.0}.asDiagonal();
  const Eigen::Vector2d chain =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(K, M).eigenvalues().cwiseSqrt();
  EXPECT_NEAR(three.omega[0], chain[0], 1e-8);
  EXPECT_NEAR(three.omega[1], 2000.0, 1e-8);
  EXPECT_NEAR(three.omega[2], chain[1], 1e-8);
}

TEST(PadBody, WithoutMassIsTheMasslessPadOnItsLiningAndSuspensionInSeries)
{
  // A light plate follows: 1 / k = 1 / k_lining + 1 / k_suspension. The error is of the order of
  // the inertia of the plate against its springs, m omega^2 / (k_l + k_s) = 6e-6 for 1 g.
  const Disc disc = pair_disc();
  const InertialDisc inertial = inertial_disc(disc);
  const SquealOptions massless = reference_options();
  PadPair pad = reference_pad();
  pad.stiffness = 1e7;
  pad.body = PadBody{.mass = 1e-3, .axial = Suspension{1.5e7, 0.0}};
  const auto expected = least_stable_eigenvalue(inertial, massless, 6.0 * pi);
  const auto error = [&](double mass) {
    pad.body->mass = mass;
    // The plates alone vibrate at sqrt(k / m), undamped: the growing mode is still the largest.
    return std::abs(least_stable_eigenvalue(inertial, options_with(pad), 6.0 * pi) - expected);
  };
  EXPECT_LT(error(1e-5), 0.01);
  EXPECT_NEAR(error(1e-3) / error(1e-4), 10.0, 0.5);
}

TEST(PadBody, OnStiffSuspensionsIsTheMasslessPad)
{
  const InertialDisc inertial = inertial_disc(pair_disc());
  const auto expected = least_stable_eigenvalue(inertial, reference_options(), 6.0 * pi);
  PadPair pad = grid_pad(1e-9, 3);
  pad.body = full_body();
  for (auto* spring : {&*pad.body->radial, &*pad.body->tangential, &*pad.body->axial})
    spring->stiffness = 1e13;
  for (auto* spring :
       {&*pad.body->about_radial, &*pad.body->about_tangential, &*pad.body->about_axial})
    spring->suspension.stiffness = 1e10;
  const Eigen::VectorXcd lambda = state_matrix(inertial, options_with(pad), 6.0 * pi).eigenvalues();
  // k / k_s = 6e-7 of the shift of 150 rad/s by the pads; rounding of 1e-16 of the stiff modes'
  // 1e7 rad/s.
  EXPECT_LT((lambda.array() - expected).abs().minCoeff(), 1e-3);
}

TEST(PadBody, IsInEquilibriumAtRest)
{
  const InertialDisc inertial = inertial_disc(pair_disc());
  PadPair pad = grid_pad(0.6, 4);
  pad.body = full_body();
  SlidingDisc motion(inertial, options_with(pad), 6.0 * pi);
  ASSERT_EQ(motion.size(), 2 * (2 + 12));
  EXPECT_LT(motion.rate(Eigen::VectorXd::Zero(motion.size())).norm(), 1e-9);
}

TEST(PadBody, HasOneLinearisationInMatrixFlowAndForce)
{
  const InertialDisc inertial = inertial_disc(pair_disc());
  PadPair pad = grid_pad(0.6, 4);
  pad.body = full_body();
  pad.caliper = Caliper{.mass = 2.0, .axial = {4e6, 10.0}};
  pad.damping = 12.0;
  SquealOptions options = options_with(pad);
  options.friction_rise = 0.2;
  const double speed = 6.0 * pi;
  SlidingDisc motion(inertial, options, speed);
  const Eigen::MatrixXd A = state_matrix(inertial, options, speed);
  ASSERT_EQ(A.rows(), 2 * (2 + 13));
  // Central differences about rest, second order: 1e-3 m kg^(1/2) / s is 1e-7 m.
  Eigen::MatrixXd differences(A.rows(), A.cols());
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    const Eigen::VectorXd h = 1e-3 * Eigen::VectorXd::Unit(A.cols(), j);
    differences.col(j) = (motion.rate(h) - motion.rate(-h)) / 2e-3;
  }
  EXPECT_LT((A - differences).cwiseAbs().maxCoeff(), 1e-7 * A.cwiseAbs().maxCoeff());
  // The flow at a large state against central differences of itself.
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(A.rows(), -2.0, 3.0);
  const Eigen::MatrixXd derivative = motion.flow(x, 1e-7, 1).derivative;
  for (const Eigen::Index j : {1, 7, 20, 29}) {
    const Eigen::VectorXd h = 1e-4 * Eigen::VectorXd::Unit(A.cols(), j);
    const Eigen::VectorXd column =
        (motion.advance(x + h, 1e-7, 1) - motion.advance(x - h, 1e-7, 1)) / 2e-4;
    EXPECT_LT((derivative.col(j) - column).norm(), 1e-7) << j;
  }
}

TEST(PadBody, GrowsInTimeAsItsEigenvaluesSay)
{
  const Disc disc = pair_disc();
  PadPair pad = grid_pad(0.3, 3);
  pad.stiffness = 2e7;
  pad.body = full_body();
  pad.body->axial = Suspension{9e6, 5.0};
  const SquealOptions options = options_with(pad);
  const double growth = least_stable_eigenvalue(inertial_disc(disc), options, 6.0 * pi).real();
  ASSERT_GT(growth, 0.5);
  // Second order in the step: 0.012 at 40 steps for a period, a sixteenth of it here.
  const Transient run = transient(disc, options,
                                  {.speed = 6.0 * pi,
                                   .duration = 1.5,
                                   .initial_pad_displacement = 3e-8,
                                   .steps_per_period = 160});
  EXPECT_NEAR(run.growth_rate.value(), growth, 2e-3);
}

TEST(PadBody, HasALimitCycleWithContactLoss)
{
  const Disc disc = pair_disc();
  PadPair pad = reference_pad();
  pad.stiffness = 2e7;
  pad.body = PadBody{.mass = 0.1, .axial = Suspension{9e6, 2.0}};
  const DirectLimitCycle cycle =
      limit_cycle_direct(disc, options_with(pad, ContactLaw::unilateral), 6.0 * pi);
  EXPECT_EQ(cycle.N_min, 0.0);
  EXPECT_EQ(cycle.multipliers.size(), 2 * (2 + 2));
  EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
}

TEST(PadBody, LosesEnergyOnlyToItsDampersWithoutFriction)
{
  // Disc, plates and caliper vibrate freely in contact: the eigenvalues of a conservative system
  // are imaginary, those of a damped one have falling amplitudes.
  const InertialDisc inertial = inertial_disc(pair_disc());
  PadPair pad = grid_pad(0.4, 3);
  pad.body = full_body();
  for (auto* spring : {&*pad.body->radial, &*pad.body->tangential, &*pad.body->axial})
    spring->damping = 0.0;
  for (auto* spring :
       {&*pad.body->about_radial, &*pad.body->about_tangential, &*pad.body->about_axial})
    spring->suspension.damping = 0.0;
  SquealOptions options = options_with(pad);
  options.friction = 0.0;
  EXPECT_LT(state_matrix(inertial, options, 18.0).eigenvalues().real().cwiseAbs().maxCoeff(), 1e-8);
  options.pads[0].body = full_body();
  EXPECT_LT(state_matrix(inertial, options, 18.0).eigenvalues().real().maxCoeff(), 1e-8);
  EXPECT_LT(state_matrix(inertial, options, 18.0).eigenvalues().real().minCoeff(), -10.0);
}

TEST(PadBody, RefusesWhatCannotMove)
{
  PadPair pad = reference_pad();
  pad.body = PadBody{.mass = 1.0};
  EXPECT_THROW(pad_system(options_with(pad), ring_radius), Error);
  pad.body = PadBody{.mass = 1.0, .tangential = Suspension{1e7, 0.0}};
  pad.caliper = Caliper{.mass = 1.0, .axial = {1e6, 0.0}};
  EXPECT_THROW(pad_system(options_with(pad), ring_radius), Error);
}

TEST(Pads, AtDifferentAnglesAddTheirForces)
{
  // Two pad pairs a quarter period of the mode apart, 30 degrees, hold both modes alike: without
  // friction the frequencies of the pair stay together.
  const InertialDisc disc = inertial_disc(pair_disc());
  SquealOptions options = reference_options();
  options.friction = 0.0;
  options.pads.push_back(options.pads[0]);
  options.pads[1].angle = pi / 6.0;
  const Eigen::MatrixXd A = state_matrix(disc, options, 1e-6);
  Eigen::VectorXd omega = A.eigenvalues().imag();
  std::sort(omega.begin(), omega.end());
  EXPECT_NEAR(omega[3] - omega[2], 0.0, 1e-4);
  EXPECT_GT(omega[3], disc.omega[0] + 50.0);
}

}  // namespace
}  // namespace chladni::squeal
