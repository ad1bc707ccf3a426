#include "mbs_export/fmu/modal_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "models.hpp"

namespace chladni::fmu {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr double round_off = 1e-13;

/// q'' + 2 D omega q' + omega^2 q = f from q0, v0, for D < 1.
Eigen::Vector2d damped_oscillator(double omega, double D, const Eigen::Vector3d& q0_v0_f, double t)
{
  const double damped = omega * std::sqrt(1.0 - D * D), decay = D * omega;
  const double rest = q0_v0_f[2] / (omega * omega);
  const double a = q0_v0_f[0] - rest, b = (q0_v0_f[1] + decay * a) / damped;
  const double c = std::cos(damped * t), s = std::sin(damped * t), e = std::exp(-decay * t);
  return {rest + e * (a * c + b * s),
          e * ((b * damped - decay * a) * c - (a * damped + decay * b) * s)};
}

/// Steps of a thousandth and of a thousand periods alike.
TEST(Propagator, IsTheClosedFormOfADampedOscillator)
{
  const double omega = 300.0, D = 0.02;
  const Eigen::Vector3d start(0.3, -20.0, 5e3);
  for (const double h : {1e-5, 1e-3, 0.05, 20.0}) {
    const Propagator step =
        propagator(VectorXd::Constant(1, omega), MatrixXd::Constant(1, 1, 2.0 * D * omega), h);
    const VectorXd x = step.from_state * start.head(2) + step.from_force * start.tail(1);
    const Eigen::Vector2d expected = damped_oscillator(omega, D, start, h);
    // The exponential of omega h loses its round-off for each period.
    const double tolerance = round_off * (1.0 + omega * h);
    EXPECT_NEAR(x[0], expected[0], tolerance * 0.4) << h;
    EXPECT_NEAR(x[1], expected[1], tolerance * 0.4 * omega) << h;
  }
}

TEST(Propagator, LetsARigidBodyFallFreely)
{
  const double h = 0.7;
  const Propagator step = propagator(VectorXd::Zero(1), MatrixXd::Zero(1, 1), h);
  EXPECT_NEAR(step.from_state(0, 1), h, round_off);
  EXPECT_NEAR(step.from_force(0, 0), h * h / 2.0, round_off);
  EXPECT_NEAR(step.from_force(1, 0), h, round_off);
}

TEST(Propagator, OfTwoHalfStepsIsThatOfTheWhole)
{
  const ModalModel model = testing::three_modes();
  const Propagator half = propagator(model.omega, model.C, 0.5e-2);
  const Propagator whole = propagator(model.omega, model.C, 1e-2);
  const MatrixXd twice = half.from_state * half.from_state;
  EXPECT_LT((twice - whole.from_state).cwiseAbs().maxCoeff(), 1e-10);
  const MatrixXd force = half.from_state * half.from_force + half.from_force;
  EXPECT_LT((force - whole.from_force).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Propagator, IsTheSameWithAndWithoutCouplingOfTheModes)
{
  ModalModel model = testing::three_modes();
  model.C = Eigen::Vector3d(0.1, 3.0, 20.0).asDiagonal();
  const Propagator apart = propagator(model.omega, model.C, 1e-2);
  model.C(0, 2) = model.C(2, 0) = 1e-300;  // no diagonal matrix any more
  const Propagator together = propagator(model.omega, model.C, 1e-2);
  EXPECT_LT((apart.from_state - together.from_state).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((apart.from_force - together.from_force).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace chladni::fmu
