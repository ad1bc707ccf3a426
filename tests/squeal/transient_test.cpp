#include "squeal/transient/transient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/motion/splitting.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TransientCase short_run(double duration = 0.05)
{
  return {.speed = 6.0 * pi,
          .duration = duration,
          .initial_pad_displacement = 1e-5,
          .steps_per_period = 40};
}

/// Strang steps of a disc with two pads, in whole steps; a state between two steps is exact in
/// time.
struct Stepper {
  OscillatorFlow half;
  ContactKick kick;
  double step;
  ModalState x;
  long n = 0;

  Stepper(const Disc& disc, const SquealOptions& options, double speed, double dt)
      : half(disc.omega, disc.C, 0.5 * dt),
        kick(disc, options, speed),
        step(dt),
        x{Eigen::VectorXd::Constant(disc.n_modes(), 2e-4),
          Eigen::VectorXd::Constant(disc.n_modes(), 3.0)}
  {}
  void advance()
  {
    half.advance(x);
    kick.apply(x, (double(n++) + 0.5) * step, step);
    half.advance(x);
  }
};

/// Energy that is conserved without friction and damping: that of the disc seen from the inertial
/// frame, and of the pad springs and the preload over the two planes.
/// H = |v|^2 / 2 + |omega q|^2 / 2 - Omega v' D q + sum N_0 h s + k (w^2 + h^2 (s - 1)^2 / 4).
double energy(const Disc& disc, const SquealOptions& options, const Stepper& run, double speed)
{
  const InertialDisc inertial = inertial_disc(disc);
  const Eigen::VectorXd a = inertial.R.transpose() * run.x.q, p = inertial.R.transpose() * run.x.v;
  double H = 0.5 * run.x.v.squaredNorm() + 0.5 * disc.omega.cwiseProduct(run.x.q).squaredNorm() -
             speed * p.dot(inertial.D * a);
  for (const PadPair& pad : options.pads) {
    const Shapes shapes = shapes_at(disc, pad.angle - speed * double(run.n) * run.step);
    const double w = shapes.W.dot(run.x.q), h = options.thickness;
    const double s = std::sqrt(1.0 + std::pow(shapes.W_r.dot(run.x.q), 2) +
                               std::pow(shapes.W_t.dot(run.x.q), 2));
    H += pad.preload * h * s + pad.stiffness * (w * w + 0.25 * h * h * (s - 1.0) * (s - 1.0));
  }
  return H;
}

/// Largest deviation of the energy over 300 periods, relative to the energy of the motion.
double energy_error(int steps_per_period)
{
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  SquealOptions options = reference_options();
  options.friction.kinetic = 0.0;
  options.pads.push_back({.angle = 1.0, .stiffness = 4e6, .damping = 0.0, .preload = 1000.0});
  const double speed = 200.0, dt = 2.0 * pi / (disc.omega.maxCoeff() * steps_per_period);
  Stepper run(disc, options, speed, dt);
  const double start = energy(disc, options, run, speed);
  double largest = 0.0;
  for (int i = 0; i < 300 * steps_per_period; ++i) {
    run.advance();
    largest = std::max(largest, std::abs(energy(disc, options, run, speed) - start));
  }
  return largest / 36.0;  // sum of v^2 / 2 + (omega q)^2 / 2 at the start is about 36 J
}

TEST(Transient, ConservesTheEnergyOfAFrictionlessDisc)
{
  // Without friction the kick is symplectic: the energy error stays bounded, and it is of second
  // order in the step.
  const double coarse = energy_error(20), fine = energy_error(40);
  EXPECT_LT(coarse, 0.02);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

TEST(Transient, GrowsAsTheEigenvaluesSay)
{
  // 40 steps per period: the splitting error of the growth rate is 1e-5 at 3.8 pi and 8e-5 at 6 pi
  // (it falls with the square of the step); the fit adds less than 1e-5.
  const Disc disc = disc_of({kirchhoff_3(1672.13)});
  for (const double speed : {3.8, 4.0, 4.2, 4.5, 5.0, 6.0}) {
    const Growth result = growth(FlexibleDisc(disc, reference_options()), speed * pi, 3.0);
    ASSERT_TRUE(result.eigenvalue_rate);
    EXPECT_NEAR(result.rate, *result.eigenvalue_rate, 1e-4) << speed << " pi";
  }
}

TEST(Transient, GrowsLikeTheReferenceSimulation)
{
  // SQUEAL reference value, an independent simulation with DOP853.
  const Growth result =
      growth(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), 5.0 * pi, 3.0);
  EXPECT_NEAR(result.rate, 1.3148926664401412, 2e-4);
}

TEST(Transient, StartsWithTheDisplacementAskedForAtRestInSpace)
{
  const TransientCase run = short_run(0.01);
  SquealOptions options = reference_options();
  options.pads[0].angle = 2.0;
  PlatePair turned = kirchhoff_3();
  turned.turn = 0.9;
  const Transient result = transient(FlexibleDisc(disc_of({kirchhoff_2(), turned}), options), run);
  // The first sample is half a step later: about (omega h / 2)^2 / 2 of it, velocity omega^2 z h
  // / 2.
  EXPECT_NEAR(result.history.pad_displacement[0], 1e-5, 5e-8);
  const double omega = 2.0 * pi * kirchhoff_3().f_Hz;
  EXPECT_LT(std::abs(result.history.pad_velocity[0]), 0.6 * omega * omega * 1e-5 * result.step);
}

TEST(Transient, DoesNotDependOnTheOrientationOfTheEigenvectors)
{
  PlatePair turned = kirchhoff_3();
  turned.turn = 0.4;
  turned.sign = -1.0;
  const auto velocity = [](const PlatePair& pair) {
    return transient(FlexibleDisc(disc_of({pair}), reference_options(ContactLaw::unilateral)),
                     short_run(0.3))
        .tail.pad_velocity;
  };
  const std::vector<double> reference = velocity(kirchhoff_3()), other = velocity(turned);
  ASSERT_EQ(reference.size(), other.size());
  // Rounding of 2e4 steps; the sign of a pair is fixed by its shape at the pad.
  for (std::size_t i = 0; i < reference.size(); i += 7)
    EXPECT_NEAR(other[i], reference[i], 1e-9 * 0.2) << i;
}

TEST(Transient, RepeatsItselfToTheLastBit)
{
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  const auto velocity = [&] {
    return transient(FlexibleDisc(disc, reference_options()), short_run()).tail.pad_velocity;
  };
  EXPECT_EQ(velocity(), velocity());
}

TEST(Transient, OfAFreeOscillationIsExactAtAnyStep)
{
  // A pad without stiffness and preload to speak of: at the pad, w = sum W_i(-Omega t) q_i(t) with
  // the closed form of a damped oscillation that starts with a' = 0, i.e. q_1' = 3 Omega q_2,
  // q_2' = -3 Omega q_1. The pad leaves the surface by h (s - 1) / 2, 2e-9 of 1e-9 m.
  const double c = 20.0, z_0 = 1e-9;
  auto body = analytic_body({kirchhoff_3()});
  body.C = c * Eigen::Matrix2d::Identity();
  SquealOptions options = reference_options();
  options.pads[0].stiffness = options.pads[0].preload = 1e-6;
  TransientCase run = short_run(0.2);
  run.steps_per_period = 8;
  run.initial_pad_displacement = z_0;
  const History history =
      transient(FlexibleDisc(disc_on_ring(body, "track", {}), options), run).history;
  const double omega = 2.0 * pi * kirchhoff_3().f_Hz, nu = std::sqrt(omega * omega - 0.25 * c * c);
  for (std::size_t i = 0; i < history.t.size(); ++i) {
    const double t = history.t[i], x = 3.0 * run.speed * t;
    const auto q = [&](double q_0, double v_0) {
      return std::exp(-0.5 * c * t) *
             (q_0 * std::cos(nu * t) + (v_0 + 0.5 * c * q_0) / nu * std::sin(nu * t));
    };
    const double w =
        std::cos(x) * q(z_0, 3.0 * run.speed * z_0) - std::sin(x) * q(z_0, -3.0 * run.speed * z_0);
    ASSERT_NEAR(history.pad_displacement[i], w, 1e-8 * z_0) << "t = " << t;
  }
}

TEST(Transient, EndsWhereTheMotionDiverges)
{
  // Negative damping of the body stands for a divergence that no contact law stops.
  auto body = analytic_body({kirchhoff_3()});
  body.C = -4e4 * Eigen::Matrix2d::Identity();
  const Transient result =
      transient(FlexibleDisc(disc_on_ring(body, "track", {}), reference_options()), short_run(1.0));
  EXPECT_FALSE(result.finished);
  EXPECT_FALSE(result.history.t.empty());
  EXPECT_LT(result.history.t.back(), 0.5);
  for (const double v : result.history.pad_velocity) EXPECT_TRUE(std::isfinite(v));
}

TEST(Transient, RunsADiscThatIsNotAxisymmetric)
{
  PlatePair split = kirchhoff_3();
  split.split = 0.05;
  const Transient result =
      transient(FlexibleDisc(disc_of({split}), reference_options()), short_run());
  EXPECT_TRUE(result.finished);
  EXPECT_EQ(result.tail_a.size(), 0);
  EXPECT_NEAR(result.history.pad_displacement[0], 1e-5, 1e-7);
}

TEST(Transient, RefusesWhatItCannotIntegrate)
{
  const Disc disc = disc_of({kirchhoff_3()});
  const auto with = [&](double TransientCase::*member, double value) {
    TransientCase run = short_run();
    run.*member = value;
    return run;
  };
  const SquealOptions options = reference_options();
  EXPECT_THROW(transient(FlexibleDisc(disc, options), with(&TransientCase::speed, 0.0)), Error);
  EXPECT_THROW(transient(FlexibleDisc(disc, options), with(&TransientCase::duration, -1.0)), Error);
  EXPECT_THROW(transient(FlexibleDisc(disc, options), with(&TransientCase::duration, 1e12)), Error);
  EXPECT_THROW(
      transient(FlexibleDisc(disc, options), with(&TransientCase::initial_pad_displacement, 0.0)),
      Error);
  TransientCase coarse = short_run();
  coarse.steps_per_period = 5;
  EXPECT_THROW(transient(FlexibleDisc(disc, options), coarse), Error);
  EXPECT_THROW(growth(FlexibleDisc(disc, options), 6.0 * pi, 1e-3), Error);  // too short for a rate
}

TEST(Transient, ReportsItsProgress)
{
  double last = -1.0;
  const auto progress = [&](double fraction) {
    EXPECT_GT(fraction, last);
    last = fraction;
  };
  transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), short_run(),
            {.progress = progress});
  EXPECT_GT(last, 0.9);
  EXPECT_LE(last, 1.0);
}

}  // namespace
}  // namespace chladni::squeal
