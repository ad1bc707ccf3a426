#include "squeal/friction.hpp"
#include "linear/dense/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pad_system.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/rigid_disc.hpp"
#include "squeal/motion/disc_motion.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

PadContact pad_on_plate(const SquealOptions& options)
{
  return pad_contact(options, options.pads[0], faces_of_plate(options.thickness, ring_radius));
}

SquealOptions stribeck_options(ContactLaw law = ContactLaw::bilateral)
{
  SquealOptions options = reference_options(law);
  options.friction.kinetic = 0.4;
  options.friction.rise = 0.3;
  options.friction.decay_speed = 1.5;
  options.friction.regularisation = 1e-3;
  return options;
}

/// A state with slopes, rates and, on the lower side, a pulled pad.
const RingMotion<double> large_ring_motion{4e-4, 0.01, -0.02, 1.5, 20.0, -30.0};

TEST(Friction, FallsFromTheStaticToTheKineticCoefficient)
{
  const FrictionLaw law{.kinetic = 0.4, .rise = 0.2, .decay_speed = 0.5};
  EXPECT_DOUBLE_EQ(friction_coefficient(law, 0.0), 0.6);
  EXPECT_DOUBLE_EQ(friction_coefficient(law, 0.5), 0.4 + 0.2 * std::exp(-1.0));
  EXPECT_NEAR(friction_coefficient(law, 50.0), 0.4, 1e-15);
}

TEST(Friction, AlwaysTakesPowerAndVanishesAtRest)
{
  // f_r, f_t on a flat disc are friction alone; the pad above slides with v_x = -h g_r' / 2 and
  // v_y = Omega r - h g_t' / 2.
  const SquealOptions options = stribeck_options();
  const PadContact pad = pad_on_plate(options);
  for (const double speed : {-2.0, 0.0, 1e-3, 0.1, 20.0}) {
    const RingMotion<double> m{0.0, 0.0, 0.0, 0.0, 0.3, -0.1};
    const PadState<double> up = pad_state(pad, m, speed, 1.0);
    const double v_x = -0.01 * 0.3, v_y = speed * ring_radius + 0.01 * 0.1;
    EXPECT_LT(up.f_r * v_x + up.f_t * v_y, 0.0) << speed;
    EXPECT_LE(std::hypot(up.f_r, up.f_t), 0.7 * 2000.0);
  }
  const RingMotion<double> still{};
  EXPECT_EQ(pad_state(pad, still, 0.0, 1.0).f_t, 0.0);
}

TEST(Friction, OfTheLinearisedContactIsTheDerivativeOfItsForce)
{
  // Central differences of the force of a bilateral and of a unilateral pad pair, second order:
  // 1e-6 of the largest derivative. With the falling coefficient, its regularisation and a cubic
  // spring.
  for (const ContactLaw law : {ContactLaw::bilateral, ContactLaw::unilateral}) {
    SquealOptions options = stribeck_options(law);
    options.pads[0].cubic_stiffness = 1e13;
    const InertialDisc disc = inertial_disc(disc_of({kirchhoff_3()}));
    SlidingDisc motion(disc, options, 20.0);
    const Eigen::VectorXd x = Eigen::Vector4d{6.0, -3.0, 2.0, 5.0};
    const double time = 1e-7;
    const Eigen::MatrixXd derivative = flow(motion, {x, time}, 1e-9).derivative;
    Eigen::Matrix4d differences;
    for (int j = 0; j < 4; ++j) {
      const Eigen::Vector4d h = 1e-4 * Eigen::Vector4d::Unit(j);
      differences.col(j) =
          (end_of(motion, {x + h, time}, 1e-9) - end_of(motion, {x - h, time}, 1e-9)) / 2e-4;
    }
    EXPECT_LT((derivative - differences).norm(), 1e-8 * derivative.norm());
    // And at rest it is the state matrix.
    const Eigen::Matrix4d at_rest =
        flow(motion, {Eigen::Vector4d::Zero(), 0.1 * time}, 1e-9).derivative -
        Eigen::Matrix4d::Identity();
    const Eigen::Matrix4d A = state_matrix(disc, options, 20.0);
    // exp(1e-8 A) - I = 1e-8 A + ..., whose third term is (1e-8 omega)^2 / 6 of the first.
    const Eigen::Matrix4d series = 1e-8 * A + 0.5e-16 * A * A;
    EXPECT_LT((at_rest - series).norm(), 1e-8 * series.norm());
  }
}

TEST(Friction, FallingOverTheSpeedAddsNegativeDampingToTheCircumferentialSlope)
{
  // F_t = -h mu(v) N per pair with v = Omega r_0 - h g_t' / 2: D_p gains (h^2 / 2) N_0 mu'(v) at
  // (t, t), while the radial slip keeps its (h^2 / 2) N_0 mu / (Omega r_0).
  SquealOptions options = stribeck_options();
  options.friction.regularisation = 0.0;
  const double speed = 12.0, v = speed * ring_radius;
  const auto D = pair_derivatives(pad_on_plate(options), speed, middle_rows);
  const double h = options.thickness, mu = 0.4 + 0.3 * std::exp(-v / 1.5);
  const double slope = -0.3 / 1.5 * std::exp(-v / 1.5);
  EXPECT_NEAR(D.D_p(2, 2), -0.5 * h * h * 2000.0 * slope, 1e-14);
  EXPECT_NEAR(D.D_p(1, 1), -0.5 * h * h * 2000.0 * mu / v, 1e-14);
}

TEST(Friction, WithoutARiseIsCoulombs)
{
  SquealOptions constant = reference_options();
  const PadContact coulomb = pad_on_plate(constant);
  constant.friction.regularisation = 1e-9;
  const PadContact regularised = pad_on_plate(constant);
  const auto a = pad_state(coulomb, large_ring_motion, 20.0, 1.0);
  const auto b = pad_state(regularised, large_ring_motion, 20.0, 1.0);
  EXPECT_NEAR(a.N, b.N, 1e-9);  // (1e-9 / 2)^2 relative
  EXPECT_NEAR(a.f_t, b.f_t, 1e-9);
}

TEST(PadSpring, StiffensByTheCubeOfItsCompression)
{
  SquealOptions options = reference_options();
  const PadContact linear = pad_on_plate(options);
  options.pads[0].cubic_stiffness = 2e13;
  const PadContact cubic = pad_on_plate(options);
  RingMotion<double> m{};
  m.w = 2e-4;
  EXPECT_NEAR(pad_state(cubic, m, 20.0, 1.0).S - pad_state(linear, m, 20.0, 1.0).S, 160.0, 1e-9);
  // To first order it is not there.
  EXPECT_EQ(pair_derivatives(cubic, 20.0, middle_rows).D_a,
            pair_derivatives(linear, 20.0, middle_rows).D_a);
}

TEST(PadSpring, ThatStiffensRaisesTheFrequencyOfTheLimitCycleAlsoWithContactLoss)
{
  // The multiplier along the cycle is 1, which takes the derivative of the flow through the loss of
  // contact, the cubic spring and the falling friction coefficient to be right.
  const Disc disc = disc_of({kirchhoff_3()});
  SquealOptions options = stribeck_options(ContactLaw::unilateral);
  options.friction.kinetic = 0.6;
  options.friction.rise = 0.05;
  const DirectLimitCycle linear = limit_cycle_direct(FlexibleDisc(disc, options), 6.0 * pi);
  options.pads[0].cubic_stiffness = 6e12;
  const DirectLimitCycle cubic = limit_cycle_direct(FlexibleDisc(disc, options), 6.0 * pi);
  for (const DirectLimitCycle& cycle : {linear, cubic}) {
    EXPECT_EQ(cycle.N_min, 0.0);
    EXPECT_LT(std::abs(cycle.multipliers[0] - 1.0), 1e-6);
  }
  EXPECT_GT(cubic.frequency_Hz, linear.frequency_Hz + 1.0);
}

TEST(RigidDiscFriction, HasOneLinearisationWithItsFallingCoefficient)
{
  // The rate of the model near rest against its state matrix: second order in the deviation, which
  // is 1e-8 of the scale of the motion.
  const RigidDisc disc{.Theta = 0.16,
                       .Phi = 0.32,
                       .k_t = 1.88e7,
                       .d_t = 0.1,
                       .radius = 0.13,
                       .thickness = 0.02,
                       .spring = {6e6, 1e13},
                       .damping = 5.0,
                       .preload = 3000.0,
                       .friction = {0.4, 0.3, 1.5, 1e-3},
                       .law = ContactLaw::unilateral};
  const RigidDiscBrake model(
      {.disc = disc, .drive = Drive::speed, .equations = RigidEquations::nonlinear});
  const Eigen::Vector4d x{1.0, -2.0, 0.5, 3.0};
  const Eigen::Vector4d expected = model.state_matrix(20.0) * x;
  const Eigen::Vector4d rate = (model.rate(1e-5 * x, 20.0) - model.rate(-1e-5 * x, 20.0)) / 2e-5;
  EXPECT_LT((rate - expected).norm(), 1e-8 * expected.norm());
}

}  // namespace
}  // namespace chladni::squeal
