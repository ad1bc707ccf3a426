#include "squeal/models/sliding_masses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "squeal/stability/eigenvalues.hpp"

namespace chladni::squeal {
namespace {

double growth_of_model(const SlidingBrake::Model& model, double belt_speed)
{
  return least_stable_eigenvalue(SlidingBrake(model).state_matrix(belt_speed)).real();
}

/// A law whose slope at the velocity V is `slope`; its coefficient stays positive.
FrictionLaw with_slope(double slope, double V)
{
  return {.kinetic = 0.5, .rise = -slope * 0.5 * std::exp(V / 0.5), .decay_speed = 0.5};
}

constexpr double belt_speed = 10.0, radius = 0.13;

/// Pad and disc with N_0 mu'(V) = -a and equal frequencies of 318 Hz.
TwoMasses equal_frequencies(double a)
{
  return {.m_1 = 0.5,
          .k_1 = 2e6,
          .d_1 = 4.0,
          .m_2 = 2.0,
          .k_2 = 8e6,
          .d_2 = 12.0,
          .preload = 1000.0,
          .radius = radius,
          .friction = with_slope(-a / 1000.0, belt_speed * radius)};
}

TEST(TwoMasses, WithEqualFrequenciesAreStableUpToTheDampersInSeries)
{
  // The third Hurwitz determinant is a_3^2 omega^2 (d_1 d_2 - a (d_1 + d_2)): closed form.
  // Round-off of the eigenvalues is 1e-13 of 2000 rad/s and more at the nearly double one.
  const double limit = 4.0 * 12.0 / (4.0 + 12.0);
  EXPECT_NEAR(growth_of_model(equal_frequencies(limit), belt_speed), 0.0, 1e-8);
  EXPECT_LT(growth_of_model(equal_frequencies(0.99 * limit), belt_speed), -1e-3);
  EXPECT_GT(growth_of_model(equal_frequencies(1.01 * limit), belt_speed), 1e-3);
}

/// a_1 a_2 a_3 - a_1^2 a_4 - a_3^2 a_0 of det(M s^2 + (D - a [1, -1; -1, 1]) s + K), positive
/// where the motion is stable.
double hurwitz(const TwoMasses& o, double a)
{
  const double a_4 = o.m_1 * o.m_2, a_3 = o.m_1 * (o.d_2 - a) + o.m_2 * (o.d_1 - a);
  const double a_2 = o.m_1 * o.k_2 + o.m_2 * o.k_1 + o.d_1 * o.d_2 - a * (o.d_1 + o.d_2);
  const double a_1 = (o.d_1 - a) * o.k_2 + (o.d_2 - a) * o.k_1, a_0 = o.k_1 * o.k_2;
  return a_1 * a_2 * a_3 - a_1 * a_1 * a_4 - a_3 * a_3 * a_0;
}

TEST(TwoMasses, LoseStabilityWhereHurwitzSaysSo)
{
  TwoMasses o = equal_frequencies(0.0);
  o.k_2 = 5e6;
  double low = 0.0, high = 12.0;
  ASSERT_GT(hurwitz(o, low), 0.0);
  ASSERT_LT(hurwitz(o, high), 0.0);
  for (int i = 0; i < 60; ++i) {
    const double a = 0.5 * (low + high);
    (hurwitz(o, a) > 0.0 ? low : high) = a;
  }
  EXPECT_GT(low, 3.0 + 0.1);  // frequencies apart: more than the dampers in series
  o.friction = with_slope(-low / o.preload, belt_speed * radius);
  EXPECT_NEAR(growth_of_model(o, belt_speed), 0.0, 1e-8);
}

TEST(TwoMasses, SquealOnAnyFallingSlopeWhenOneOfThemHasNoDamper)
{
  // d_1 d_2 / (d_1 + d_2) = 0, however strong the other damper is.
  for (const double d_1 : {1.0, 10.0, 100.0}) {
    TwoMasses o = equal_frequencies(0.1);
    o.d_1 = d_1;
    o.d_2 = 0.0;
    EXPECT_GT(growth_of_model(o, belt_speed), 1e-5) << d_1;
  }
}

TEST(TwoMasses, AreDampedByFrictionThatRisesWithTheSpeed)
{
  // The damping matrix gains N_0 mu' [1, -1; -1, 1], and the trace of the state matrix loses that
  // over both masses; without dampers the motion decays.
  TwoMasses o = equal_frequencies(-6.0);
  o.d_1 = o.d_2 = 0.0;
  o.k_2 = 5e6;
  EXPECT_NEAR(SlidingBrake(o).state_matrix(belt_speed).trace(), -6.0 / 0.5 - 6.0 / 2.0, 1e-9);
  EXPECT_LT(growth_of_model(o, belt_speed), -1.0);
}

/// Undamped; tilting and normal motion have frequencies near 530 Hz.
TiltingBlock block(double mu)
{
  return {.mass = 1.0,
          .inertia = 4e-4,
          .k_x = 1.2e7,
          .k_y = 4e6,
          .k_phi = 1800.0,
          .d_x = 0.0,
          .d_y = 0.0,
          .d_phi = 0.0,
          .height = 0.02,
          .foot_length = 0.04,
          .foot_offset = -0.002,
          .contact_stiffness = 7e6,
          .preload = 500.0,
          .radius = radius,
          .friction = {mu}};
}

/// The friction at which the frequencies of y and phi meet, the smaller root of
///   (alpha - beta)^2 + 4 k_c b k_c (b + mu h) / (m J) = 0,  alpha = (k_y + k_c) / m,
///   beta = (k_phi + k_c (b^2 + l^2 / 4) + mu h k_c b) / J
double flutter_friction(const TiltingBlock& o)
{
  const double b = o.foot_offset, k_c = o.contact_stiffness, h = o.height;
  const double arm = b * b + 0.25 * o.foot_length * o.foot_length;
  const double difference = (o.k_y + k_c) / o.mass - (o.k_phi + k_c * arm) / o.inertia;
  const double slope = -h * k_c * b / o.inertia;  // of alpha - beta over mu
  const double coupling = 4.0 * k_c * k_c * b / (o.mass * o.inertia);
  const double B = 2.0 * difference * slope + coupling * h;
  const double C = difference * difference + coupling * b;
  return (-B - std::sqrt(B * B - 4.0 * slope * slope * C)) / (2.0 * slope * slope);
}

TEST(TiltingBlock, FluttersWhereTheFrequenciesOfTiltingAndNormalMotionMeet)
{
  const double critical = flutter_friction(block(0.0));
  EXPECT_GT(critical, 0.1);  // |b| / h: below it both couplings have one sign
  EXPECT_LT(critical, 0.2);
  // Eigenvalues go with the root of the distance, omega sqrt(1e-6) is 3.
  EXPECT_LT(growth_of_model(block(critical * (1.0 - 1e-6)), belt_speed), 1e-5);
  EXPECT_GT(growth_of_model(block(critical * (1.0 + 1e-6)), belt_speed), 0.01);
}

TEST(TiltingBlock, IsStableWithTheFootInTheMiddle)
{
  TiltingBlock o = block(0.6);
  o.foot_offset = 0.0;
  EXPECT_LT(growth_of_model(o, belt_speed), 1e-6);
}

TEST(TiltingBlock, SquealsWithFrictionThatRisesWithTheSpeed)
{
  TiltingBlock o = block(0.0);
  o.friction = {.kinetic = 0.5, .rise = -0.2, .decay_speed = 0.5};
  const double slope = 0.2 / 0.5 * std::exp(-belt_speed * radius / 0.5);
  const SlidingBrake model(o);
  // Friction damps x - h phi: over m, and h^2 over J.
  const double gain = o.preload * slope;
  EXPECT_NEAR(model.state_matrix(belt_speed).trace(),
              -gain * (1.0 / o.mass + o.height * o.height / o.inertia), 1e-8);
  EXPECT_GT(growth_of_model(o, belt_speed), 100.0);
}

TEST(TiltingBlock, HasTheMatricesOfItsEquations)
{
  TiltingBlock o = block(0.4);
  o.d_x = 3.0;
  o.d_y = 5.0;
  o.d_phi = 0.01;
  const double b = o.foot_offset, k_c = o.contact_stiffness, h = o.height, mu = 0.4;
  const double arm = b * b + 0.25 * o.foot_length * o.foot_length;
  Eigen::Matrix3d K;
  K << o.k_x, -mu * k_c, -mu * k_c * b,  //
      0.0, o.k_y + k_c, k_c * b,         //
      0.0, k_c * b + mu * h * k_c, o.k_phi + k_c * arm + mu * h * k_c * b;
  const Eigen::Vector3d M(o.mass, o.mass, o.inertia), d(o.d_x, o.d_y, o.d_phi);
  const double w = std::sqrt(o.k_x / o.mass);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6, 6);
  A.topRightCorner(3, 3) = w * Eigen::Matrix3d::Identity();
  A.bottomLeftCorner(3, 3) = M.cwiseInverse().asDiagonal() * K * (-1.0 / w);
  A.bottomRightCorner(3, 3) = -d.cwiseQuotient(M).asDiagonal().toDenseMatrix();
  EXPECT_LT((SlidingBrake(o).state_matrix(belt_speed) - A).norm(), 1e-13 * A.norm());
}

TEST(TiltingBlock, LiftsOneEndOfItsFoot)
{
  const SlidingBrake model(block(0.4));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.size());
  x[2] = std::sqrt(1.2e7) * 0.01;  // phi = 0.01 lifts the end at -22 mm by 220 um, 3 N_0 / k_c
  const ContactResult<double> ends = model.contact(x, belt_speed);
  EXPECT_EQ(ends.upper.N, 0.0);
  EXPECT_NEAR(ends.lower.N, 250.0 + 3.5e6 * 0.018 * 0.01, 1e-9);
}

TEST(SlidingBrake, VariesByTheKeysOfItsModel)
{
  TwoMasses o = equal_frequencies(2.0);
  const SlidingBrake brake(o);
  o.d_2 = 7.0;
  EXPECT_EQ(brake.with({"two_masses.disc_damping"}, 7.0)->state_matrix(belt_speed),
            SlidingBrake(o).state_matrix(belt_speed));
  TiltingBlock foot = block(0.4);
  const SlidingBrake standing(foot);
  foot.foot_offset = 0.003;
  EXPECT_EQ(standing.with({"tilting_block.foot_offset"}, 0.003)->state_matrix(belt_speed),
            SlidingBrake(foot).state_matrix(belt_speed));
  EXPECT_EQ(standing.parameters().size(), 1u + 14u);  // friction, and the keys of its table
  EXPECT_EQ(brake.parameters().size(), 3u + 8u);      // kinetic, static, decay_speed
}

}  // namespace
}  // namespace chladni::squeal
