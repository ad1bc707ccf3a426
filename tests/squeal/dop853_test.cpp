#include "squeal/motion/dop853.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace chladni::squeal {
namespace {

/// The pendulum (x, x'): nonlinear, so that all conditions of order matter.
Eigen::Vector2d pendulum(const Eigen::Vector2d& y)
{
  return {y[1], -std::sin(y[0])};
}

Eigen::Vector2d swing(int n_steps)
{
  Eigen::Vector2d y(1.5, 0.0);
  for (int i = 0; i < n_steps; ++i) y = dop853_step(pendulum, y, 3.0 / n_steps);
  return y;
}

TEST(Dop853, IsOfOrderEight)
{
  const Eigen::Vector2d exact = swing(96);
  const double coarse = (swing(6) - exact).norm(), fine = (swing(12) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 8.0, 0.6);
}

TEST(Dop853, KeepsTheEnergyOfAPendulum)
{
  const auto energy = [](const Eigen::Vector2d& y) { return 0.5 * y[1] * y[1] - std::cos(y[0]); };
  EXPECT_NEAR(energy(swing(48)), energy({1.5, 0.0}), 1e-13);  // (3 / 48)^8 = 2e-10, times 1e-5
}

}  // namespace
}  // namespace chladni::squeal
