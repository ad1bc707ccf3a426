#pragma once

#include "linear/dense/dense_solvers.hpp"
#include "squeal/motion/motion.hpp"

namespace chladni::squeal {

/// Default spectral radius rho of the generalised-alpha method.
inline constexpr double spectral_radius_default = 0.98;

/// Numerical damping of an oscillation by steps with the default spectral radius rho, to leading
/// order ((1 - rho) / (1 + rho))^3 omega^4 h^3 / 2.
/// @return 1/s
inline double damping_of_step(double omega, double step)
{
  constexpr double ratio = (1.0 - spectral_radius_default) / (1.0 + spectral_radius_default);
  const double x = ratio * omega * step;
  return 0.5 * omega * x * x * x;
}

/// The implicit generalised-alpha method of second order with adaptive steps:
///   (1 - alpha_m) a_1 + alpha_m a_0 = g(t_0 + (1 - alpha_f) h, (1 - alpha_f) (q_1, v_1)
///                                                              + alpha_f (q_0, v_0))
///   q_1 = q_0 + h v_0 + h^2 ((1/2 - beta) a_0 + beta a_1)
///   v_1 = v_0 + h ((1 - gamma) a_0 + gamma a_1)
/// rho is the spectral radius of a step at infinite frequency. With rho = 1 there is no numerical
/// damping, even of frequencies that the step does not resolve: after a sticking pad stops, they
/// ring and keep the steps short. The damping of a resolved oscillation, `damping_of_step`, is of
/// third order in 1 - rho. The method is stable for any step. Sides are those of the point where g
/// is evaluated, and are not located.
/// Source: Chung, Hulbert, Journal of Applied Mechanics 60 (1993) 371-375.
class GeneralisedAlpha final : public Integrator {
 public:
  /// @param motion           must outlive the integrator, which sets its sides
  /// @param spectral_radius  rho at infinite frequency, 0 to 1
  GeneralisedAlpha(Motion& motion, double t, const Eigen::VectorXd& y, const StepControl& control,
                   double spectral_radius = spectral_radius_default);

  const Eigen::VectorXd& at(double t) override;

 private:
  void advance();
  double try_step(double step);
  bool solve(double step);
  void place_end(double step);
  void factorize(double t, const Eigen::VectorXd& y, double step);
  Eigen::VectorXd acceleration(double t, const Eigen::VectorXd& y);

  Motion& motion_;
  StepControl control_;
  double alpha_m_, alpha_f_, beta_, gamma_;
  double t_;                   ///< end of the last step, s
  double step_;                ///< the last step, s
  double step_next_;           ///< s
  double error_held_ = 0.0;    ///< largest error of recent steps relative to the tolerance
  Eigen::VectorXd y_, begin_;  ///< (diag(omega) q, v) at the end and the begin of the last step
  Eigen::VectorXd a_, a_begin_;
  Eigen::VectorXd end_, a_end_;  ///< end of the step being tried
  Eigen::VectorXd stage_;
  Eigen::VectorXd sample_;
  Eigen::MatrixXd tangent_;  ///< matrix of Newton's method
  Eigen::PartialPivLU<Eigen::MatrixXd> newton_;
  double step_factorized_ = 0.0;  ///< step size for which `newton_` was computed
};

}  // namespace chladni::squeal
