#include "squeal/brake/pad_system.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "common/error.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

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

PadPair pair_of_reference()
{
  return reference_options().pads.front();
}

PadPair grid_pad(double sector, int points)
{
  PadPair pad = pair_of_reference();
  pad.grid = PadGrid{.sector = sector, .points = points};
  return pad;
}

TEST(PadBody, HasTheFrequenciesOfItsSuspension)
{
  PadPair pad = pair_of_reference();
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

TEST(PadMatrices, HaveEqualAndOppositeForcesBetweenPlatesAndCaliper)
{
  PadPair pad = pair_of_reference();
  pad.body =
      PadBody{.mass = 0.5, .tangential = Suspension{3e6, 2.0}, .axial = Suspension{2e6, 7.0}};
  pad.caliper = Caliper{.mass = 3.0, .axial = {1e6, 5.0}};
  const PadMatrices found = pad_matrices(options_with(pad));  // of a plate, the other, the caliper
  Eigen::MatrixXd K{
      {3, 0, 0, 0, 0}, {0, 2, 0, 0, -2}, {0, 0, 3, 0, 0}, {0, 0, 0, 2, -2}, {0, -2, 0, -2, 5}};
  EXPECT_EQ(found.K, 1e6 * K);
  EXPECT_EQ(found.C, (Eigen::MatrixXd{{2, 0, 0, 0, 0},
                                      {0, 7, 0, 0, -7},
                                      {0, 0, 2, 0, 0},
                                      {0, 0, 0, 7, -7},
                                      {0, -7, 0, -7, 19}}));
  EXPECT_EQ(found.M.diagonal(), (Eigen::VectorXd{{0.5, 0.5, 0.5, 0.5, 3.0}}));
  EXPECT_TRUE(found.M.isDiagonal(0.0));
}

TEST(PadBody, WithoutMassIsTheMasslessPadOnItsLiningAndSuspensionInSeries)
{
  // A light plate follows: 1 / k = 1 / k_lining + 1 / k_suspension. The error is of the order of
  // the inertia of the plate against its springs, m omega^2 / (k_l + k_s) = 6e-6 for 1 g.
  const Disc disc = disc_of({kirchhoff_3()});
  const InertialDisc inertial = inertial_disc(disc);
  const SquealOptions massless = reference_options();
  PadPair pad = pair_of_reference();
  pad.stiffness = 1e7;
  pad.body = PadBody{.mass = 1e-3, .axial = Suspension{1.5e7, 0.0}};
  const auto expected = least_stable_eigenvalue(state_matrix(inertial, massless, 6.0 * pi));
  const auto error = [&](double mass) {
    pad.body->mass = mass;
    // The plates alone vibrate at sqrt(k / m), undamped: the growing mode is still the largest.
    return std::abs(least_stable_eigenvalue(state_matrix(inertial, options_with(pad), 6.0 * pi)) -
                    expected);
  };
  EXPECT_LT(error(1e-5), 0.01);
  EXPECT_NEAR(error(1e-3) / error(1e-4), 10.0, 0.5);
}

TEST(PadBody, OnStiffSuspensionsIsTheMasslessPad)
{
  const InertialDisc inertial = inertial_disc(disc_of({kirchhoff_3()}));
  const auto expected =
      least_stable_eigenvalue(state_matrix(inertial, reference_options(), 6.0 * pi));
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
  const InertialDisc inertial = inertial_disc(disc_of({kirchhoff_3()}));
  PadPair pad = grid_pad(0.6, 4);
  pad.body = full_body();
  SlidingDisc motion(inertial, options_with(pad), 6.0 * pi);
  ASSERT_EQ(motion.size(), 2 * (2 + 12));
  EXPECT_LT(motion.rate_at(Eigen::VectorXd::Zero(motion.size())).norm(), 1e-9);
}

TEST(PadBody, HasOneLinearisationInMatrixFlowAndForce)
{
  const InertialDisc inertial = inertial_disc(disc_of({kirchhoff_3()}));
  PadPair pad = grid_pad(0.6, 4);
  pad.body = full_body();
  pad.caliper = Caliper{.mass = 2.0, .axial = {4e6, 10.0}};
  pad.damping = 12.0;
  SquealOptions options = options_with(pad);
  options.friction.rise = 0.2;
  const double speed = 6.0 * pi;
  SlidingDisc motion(inertial, options, speed);
  const Eigen::MatrixXd A = state_matrix(inertial, options, speed);
  ASSERT_EQ(A.rows(), 2 * (2 + 13));
  // Central differences about rest, second order: 1e-3 m kg^(1/2) / s is 1e-7 m.
  Eigen::MatrixXd differences(A.rows(), A.cols());
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    const Eigen::VectorXd h = 1e-3 * Eigen::VectorXd::Unit(A.cols(), j);
    differences.col(j) = (motion.rate_at(h) - motion.rate_at(-h)) / 2e-3;
  }
  EXPECT_LT((A - differences).cwiseAbs().maxCoeff(), 1e-7 * A.cwiseAbs().maxCoeff());
  // The flow at a large state against central differences of itself.
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(A.rows(), -2.0, 3.0);
  const Eigen::MatrixXd derivative = flow(motion, {x, 1e-7}, 1e-9).derivative;
  for (const Eigen::Index j : {1, 7, 20, 29}) {
    const Eigen::VectorXd h = 1e-4 * Eigen::VectorXd::Unit(A.cols(), j);
    const Eigen::VectorXd column =
        (end_of(motion, {x + h, 1e-7}, 1e-9) - end_of(motion, {x - h, 1e-7}, 1e-9)) / 2e-4;
    EXPECT_LT((derivative.col(j) - column).norm(), 1e-7) << j;
  }
}

TEST(PadBody, GrowsInTimeAsItsEigenvaluesSay)
{
  const Disc disc = disc_of({kirchhoff_3()});
  PadPair pad = grid_pad(0.3, 3);
  pad.stiffness = 2e7;
  pad.body = full_body();
  pad.body->axial = Suspension{9e6, 5.0};
  const SquealOptions options = options_with(pad);
  const double growth =
      least_stable_eigenvalue(state_matrix(inertial_disc(disc), options, 6.0 * pi)).real();
  ASSERT_GT(growth, 0.5);
  // The decaying modes leave 1e-3 to the fit.
  // Second order in the step of the splitting, 0.012 at 40 steps for a period; exact by
  // "exponential".
  TransientCase run{.speed = 6.0 * pi,
                    .duration = 1.5,
                    .initial_pad_displacement = 3e-8,
                    .steps_per_period = 160,
                    .integrator = IntegratorKind::splitting};
  EXPECT_NEAR(transient(FlexibleDisc(disc, options), run).growth_rate.value(), growth, 2e-3);
  run.steps_per_period = 40;
  run.integrator = IntegratorKind::exponential;
  EXPECT_NEAR(transient(FlexibleDisc(disc, options), run).growth_rate.value(), growth, 2e-3);
  run.steps_per_period = 10;
  run.integrator = IntegratorKind::dormand_prince;
  EXPECT_NEAR(transient(FlexibleDisc(disc, options), run).growth_rate.value(), growth, 2e-3);
}

TEST(PadBody, HasALimitCycleWithContactLoss)
{
  const Disc disc = disc_of({kirchhoff_3()});
  PadPair pad = pair_of_reference();
  pad.stiffness = 2e7;
  pad.body = PadBody{.mass = 0.1, .axial = Suspension{9e6, 2.0}};
  const DirectLimitCycle cycle =
      limit_cycle_direct(FlexibleDisc(disc, options_with(pad, ContactLaw::unilateral)), 6.0 * pi);
  EXPECT_EQ(cycle.N_min, 0.0);
  EXPECT_EQ(cycle.multipliers.size(), 2 * (2 + 2));
  EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
  // 256 samples of powers with kinks leave about 1e-4 of the largest.
  const CycleEnergy& energy = cycle.energy;
  const double sum = energy.friction.sum() + energy.normal.sum() + energy.damping;
  EXPECT_LT(std::abs(sum), 2e-3 * energy.friction.cwiseAbs().maxCoeff());
  EXPECT_LT(energy.damping, 0.0);
}

TEST(PadBody, GainsTheEnergyThatTheSourcesPutIn)
{
  // d/dt |x|^2 / 2 = x^T f(x) at any state, also where pads are off.
  const InertialDisc inertial = inertial_disc(disc_of({kirchhoff_3()}));
  PadPair pad = grid_pad(0.6, 4);
  pad.body = full_body();
  pad.caliper = Caliper{.mass = 2.0, .axial = {4e6, 10.0}};
  pad.damping = 12.0;
  SquealOptions options = options_with(pad, ContactLaw::unilateral);
  options.pads.push_back(grid_pad(0.3, 2));
  options.pads[1].angle = 2.0;
  SlidingDisc motion(inertial, options, 6.0 * pi);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(motion.size(), -4.0, 3.0);
  const SlidingDisc::Power power = motion.sample(x).power;
  ASSERT_EQ(power.friction.size(), 2);
  const double expected = x.dot(motion.rate_at(x));
  const double sum = power.friction.sum() + power.normal.sum() + power.damping;
  EXPECT_NEAR(sum, expected, 1e-9 * power.normal.cwiseAbs().maxCoeff());
  // Each pad by itself: the disc alone with the second one.
  options.pads.erase(options.pads.begin());
  SlidingDisc second(inertial, options, 6.0 * pi);
  Eigen::Vector4d of_disc;
  of_disc << x.head(2), x.segment(x.size() / 2, 2);
  EXPECT_NEAR(second.sample(of_disc).power.normal[0], power.normal[1],
              1e-9 * std::abs(power.normal[1]));
  EXPECT_NEAR(second.sample(of_disc).power.friction[0], power.friction[1],
              1e-9 * std::abs(power.normal[1]));
}

TEST(PadBody, HasItsPartInTheModeShapes)
{
  const InertialDisc inertial = inertial_disc(disc_of({kirchhoff_3()}));
  PadPair pad = grid_pad(0.6, 4);
  pad.body = full_body();
  SquealOptions options = options_with(pad);
  options.study.speeds = {.from = 18.0, .to = 18.0, .count = 1};
  const EigenvalueMap map = eigenvalues(at_speeds(inertial, options), options.study.speeds);
  const Eigen::MatrixXcd shapes = mode_shapes(inertial, options, map).at(0);
  ASSERT_EQ(shapes.rows(), 2 + 12);
  const InertialDisc brake = with_pads(inertial, pad_system(options, ring_places(inertial)));
  const Eigen::MatrixXcd A = state_matrix(inertial, options, 18.0).cast<std::complex<double>>();
  for (Eigen::Index j = 0; j < shapes.cols(); ++j) {
    // p = (lambda + Omega D) a; rounding of A, whose fastest modes have 3e4 rad/s.
    const Eigen::VectorXcd a = brake.R.transpose().cast<std::complex<double>>() * shapes.col(j);
    Eigen::VectorXcd x(28);
    x << brake.omega.cast<std::complex<double>>().cwiseProduct(a),
        map.lambda(0, j) * a + 18.0 * (brake.D.cast<std::complex<double>>() * a);
    EXPECT_LT((A * x - map.lambda(0, j) * x).norm(), 1e-9 * A.norm() * x.norm()) << j;
    EXPECT_NEAR(shapes.col(j).norm(), 1.0, 1e-12);
  }
}

TEST(PadBody, LosesEnergyOnlyToItsDampersWithoutFriction)
{
  // Disc, plates and caliper vibrate freely in contact: the eigenvalues of a conservative system
  // are imaginary, those of a damped one have falling amplitudes.
  const InertialDisc inertial = inertial_disc(disc_of({kirchhoff_3()}));
  PadPair pad = grid_pad(0.4, 3);
  pad.body = full_body();
  for (auto* spring : {&*pad.body->radial, &*pad.body->tangential, &*pad.body->axial})
    spring->damping = 0.0;
  for (auto* spring :
       {&*pad.body->about_radial, &*pad.body->about_tangential, &*pad.body->about_axial})
    spring->suspension.damping = 0.0;
  SquealOptions options = options_with(pad);
  options.friction.kinetic = 0.0;
  EXPECT_LT(state_matrix(inertial, options, 18.0).eigenvalues().real().cwiseAbs().maxCoeff(), 1e-8);
  options.pads[0].body = full_body();
  EXPECT_LT(state_matrix(inertial, options, 18.0).eigenvalues().real().maxCoeff(), 1e-8);
  EXPECT_LT(state_matrix(inertial, options, 18.0).eigenvalues().real().minCoeff(), -10.0);
}

TEST(PadBody, RefusesWhatCannotMove)
{
  PadPair pad = pair_of_reference();
  pad.body = PadBody{.mass = 1.0};
  EXPECT_THROW(pad_system(options_with(pad), ring_radius), Error);
  pad.body = PadBody{.mass = 1.0, .tangential = Suspension{1e7, 0.0}};
  pad.caliper = Caliper{.mass = 1.0, .axial = {1e6, 0.0}};
  EXPECT_THROW(pad_system(options_with(pad), ring_radius), Error);
}

}  // namespace
}  // namespace chladni::squeal
