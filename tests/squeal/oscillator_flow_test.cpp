#include "squeal/motion/splitting.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace chladni::squeal {
namespace {

const double omega_0 = 1.1e4;

TEST(OscillatorFlow, IsTheDampedOscillation)
{
  const double c = 300.0, time = 2e-5;
  const OscillatorFlow flow(Eigen::VectorXd::Constant(1, omega_0),
                            Eigen::MatrixXd::Constant(1, 1, c), time);
  ModalState x{Eigen::VectorXd::Constant(1, 2e-3), Eigen::VectorXd::Zero(1)};
  for (int i = 0; i < 50; ++i) flow.advance(x);
  const double t = 50 * time, delta = 0.5 * c, nu = std::sqrt(omega_0 * omega_0 - delta * delta);
  const double q = 2e-3 * std::exp(-delta * t) * (std::cos(nu * t) + delta / nu * std::sin(nu * t));
  EXPECT_NEAR(x.q[0], q, 1e-15);  // 50 roundings of 2e-3
}

TEST(OscillatorFlow, ConservesTheEnergyOfUndampedModes)
{
  const OscillatorFlow flow(Eigen::VectorXd::Constant(1, omega_0), Eigen::MatrixXd::Zero(1, 1),
                            1e-5);
  ModalState x{Eigen::VectorXd::Constant(1, 1e-3), Eigen::VectorXd::Constant(1, 4.0)};
  const auto energy = [&] { return std::hypot(omega_0 * x.q[0], x.v[0]); };
  const double start = energy();
  for (int i = 0; i < 100000; ++i) flow.advance(x);
  EXPECT_NEAR(energy(), start, 1e-10 * start);  // 1e5 steps of rounding
}

TEST(OscillatorFlow, OfCoupledModesIsTheProductOfItsHalves)
{
  const Eigen::Vector2d omega{9e3, omega_0};
  const Eigen::Matrix2d C{{40.0, 25.0}, {-10.0, 60.0}};
  const OscillatorFlow whole(omega, C, 1e-3), half(omega, C, 5e-4);
  ModalState x{Eigen::Vector2d{1e-3, -2e-3}, Eigen::Vector2d{3.0, 5.0}}, y = x;
  whole.advance(x);
  half.advance(y);
  half.advance(y);
  EXPECT_LT((x.q - y.q).norm(), 1e-14);
  EXPECT_LT((x.v - y.v).norm(), 1e-10);
}

TEST(OscillatorFlow, TreatsDiagonalDampingModeByMode)
{
  // A coupling far below rounding of the result must give what no coupling gives.
  const Eigen::Vector2d omega{9e3, omega_0};
  Eigen::Matrix2d C = Eigen::Vector2d{40.0, 60.0}.asDiagonal();
  const OscillatorFlow apart(omega, C, 2e-5);
  C(0, 1) = 1e-9;
  const OscillatorFlow together(omega, C, 2e-5);
  ModalState x{Eigen::Vector2d{1e-3, -2e-3}, Eigen::Vector2d{3.0, 5.0}}, y = x;
  apart.advance(x);
  together.advance(y);
  EXPECT_LT((x.q - y.q).norm(), 1e-15);
  EXPECT_LT((x.v - y.v).norm(), 1e-11);
}

}  // namespace
}  // namespace chladni::squeal
