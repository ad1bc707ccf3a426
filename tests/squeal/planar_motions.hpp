#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "squeal/motion/motion.hpp"

namespace chladni::squeal::test {

/// A smooth motion of two coordinates, for what is known of periodic motions in closed form.
template <class Field>
class PlanarMotion final : public AutonomousMotion {
 public:
  explicit PlanarMotion(Field field) : field_(field) {}

  Eigen::Index size() const override { return 2; }
  double omega_highest() const override { return 2.0; }
  const Eigen::VectorXd& rate(double /*t*/, const Eigen::VectorXd& x) override
  {
    ++n_evaluations_;
    f_ = field_.rate(x);
    return f_;
  }
  const Eigen::VectorXd& switches() const override { return none_; }
  double side(Eigen::Index /*i*/) const override { return 1.0; }
  void set_side(Eigen::Index /*i*/, double /*side*/) override {}
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x) override
  {
    n_evaluations_ += 2;
    return field_.jacobian(x);
  }
  /// The "pad" moves as x_1.
  ContactResult<double> first_contact(const Eigen::VectorXd& x) override
  {
    ContactResult<double> contact{};
    contact.upper.z = x[0];
    contact.upper.z_dot = field_.rate(x)[0];
    return contact;
  }

 private:
  Field field_;
  Eigen::VectorXd f_, none_;
};

/// x_1' = x_2, x_2' = (1 - x_1^2) x_2 - x_1: van der Pol's oscillator with mu = 1.
struct VanDerPol {
  Eigen::Vector2d rate(const Eigen::VectorXd& x) const
  {
    return {x[1], (1.0 - x[0] * x[0]) * x[1] - x[0]};
  }
  Eigen::Matrix2d jacobian(const Eigen::VectorXd& x) const
  {
    return Eigen::Matrix2d{{0.0, 1.0}, {-2.0 * x[0] * x[1] - 1.0, 1.0 - x[0] * x[0]}};
  }
};
/// Its period (Andersen, Geer, SIAM J. Appl. Math. 42 (1982) 678, and many since).
inline constexpr double van_der_pol_period = 6.66328685932313;

/// r' = r (speed - 2 + r^2 - r^4), phi' = 1 + twist r^2: rest is unstable above 2; from there an
/// unstable cycle goes back to the fold at 7 / 4, r^2 = 1 / 2, and a stable one forward again. With
/// a twist, disturbances of r grow into ones of the phase, so that 1 is a defective double
/// eigenvalue of the monodromy matrix at the fold.
struct SubcriticalHopf {
  double speed;
  double twist = 0.0;

  Eigen::Vector2d rate(const Eigen::VectorXd& x) const
  {
    const double s = x.squaredNorm(), g = speed - 2.0 + s - s * s, w = 1.0 + twist * s;
    return {g * x[0] - w * x[1], g * x[1] + w * x[0]};
  }
  Eigen::Matrix2d jacobian(const Eigen::VectorXd& x) const
  {
    const double s = x.squaredNorm(), g = speed - 2.0 + s - s * s, w = 1.0 + twist * s;
    const Eigen::RowVector2d by_x = 2.0 * x.transpose();
    Eigen::Matrix2d J{{g, -w}, {w, g}};
    J += (1.0 - 2.0 * s) * x * by_x + twist * Eigen::Vector2d(-x[1], x[0]) * by_x;
    return J;
  }
  /// The cycle with r^2 = s, at speed 2 - s + s^2: its period and its multiplier.
  double period(double s) const { return 2.0 * std::numbers::pi / (1.0 + twist * s); }
  double multiplier(double s) const { return std::exp(period(s) * (2.0 * s - 4.0 * s * s)); }
};

}  // namespace chladni::squeal::test
