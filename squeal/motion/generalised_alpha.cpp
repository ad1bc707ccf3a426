#include "squeal/motion/generalised_alpha.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace chladni::squeal {
namespace {

/// Remaining error of Newton's method, relative to the tolerance of a step.
constexpr double newton_part = 1e-3;
constexpr int alpha_newton_steps_max = 8;
/// A Newton step may be at most this part of the one before, or the tangent is made anew.
constexpr double contraction = 0.2;
constexpr double alpha_safety = 0.9, alpha_shrink_max = 0.3, alpha_grow_max = 2.0;
/// A step is kept rather than enlarged by less, since a new one needs a new tangent.
constexpr double worth_growing = 1.25;
/// The error estimate of an oscillation swings with it; its peak is remembered with this factor.
constexpr double forgetting = 0.98;

}  // namespace

GeneralisedAlpha::GeneralisedAlpha(Motion& motion, double t, const Eigen::VectorXd& y,
                                   const StepControl& control, double spectral_radius)
    : motion_(motion),
      control_(control),
      alpha_m_((2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0)),
      alpha_f_(spectral_radius / (spectral_radius + 1.0)),
      beta_(0.25 * (1.0 - alpha_m_ + alpha_f_) * (1.0 - alpha_m_ + alpha_f_)),
      gamma_(0.5 - alpha_m_ + alpha_f_),
      t_(t),
      step_(0.0),
      step_next_(control.step_first),
      y_(y),
      begin_(y),
      a_(acceleration(t, y)),
      a_begin_(a_),
      end_(y),
      a_end_(a_),
      stage_(y),
      sample_(y)
{}

/// g(t, y) with all sides as they are there.
Eigen::VectorXd GeneralisedAlpha::acceleration(double t, const Eigen::VectorXd& y)
{
  const Eigen::VectorXd* f = &motion_.rate(t, y);
  bool changed = false;
  for (Eigen::Index i = 0; i < motion_.switches().size(); ++i) {
    const double side = motion_.switches()[i] < 0.0 ? -1.0 : 1.0;
    changed = changed || side != motion_.side(i);
    motion_.set_side(i, side);
  }
  if (changed) f = &motion_.rate(t, y);
  return f->tail(motion_.omega().size());
}

/// Interpolation by the cubic polynomials with the values and the rates of the ends.
const Eigen::VectorXd& GeneralisedAlpha::at(double t)
{
  while (t_ < t && y_.allFinite()) advance();
  if (t >= t_ || step_ == 0.0) return y_;
  const Eigen::VectorXd& omega = motion_.omega();
  const Eigen::Index n = omega.size();
  const double x = 1.0 - (t_ - t) / step_;
  const double h_00 = (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x), h_10 = x * (1.0 - x) * (1.0 - x),
               h_01 = x * x * (3.0 - 2.0 * x), h_11 = x * x * (x - 1.0);
  sample_ = h_00 * begin_ + h_01 * y_;
  sample_.head(n) += step_ * omega.cwiseProduct(h_10 * begin_.tail(n) + h_11 * y_.tail(n));
  sample_.tail(n) += step_ * (h_10 * a_begin_ + h_11 * a_);
  return sample_;
}

void GeneralisedAlpha::factorize(double t, const Eigen::VectorXd& y, double step)
{
  const Motion::Tangent d = motion_.tangent(t, y);
  const Eigen::Index n = d.by_q.rows();
  tangent_ = (1.0 - alpha_m_) * Eigen::MatrixXd::Identity(n, n) -
             (1.0 - alpha_f_) * (beta_ * step * step * d.by_q + gamma_ * step * d.by_v);
  newton_.compute(tangent_);
  step_factorized_ = step;
  ++cost_.n_factorizations;
}

/// q_1 and v_1 from a_1.
void GeneralisedAlpha::place_end(double step)
{
  const Eigen::VectorXd& omega = motion_.omega();
  const Eigen::Index n = omega.size();
  end_.head(n) =
      y_.head(n) +
      omega.cwiseProduct(step * y_.tail(n) + step * step * ((0.5 - beta_) * a_ + beta_ * a_end_));
  end_.tail(n) = y_.tail(n) + step * ((1.0 - gamma_) * a_ + gamma_ * a_end_);
}

/// Newton's method for a_1, from a_0; true when it has converged.
bool GeneralisedAlpha::solve(double step)
{
  const double t = t_ + (1.0 - alpha_f_) * step;
  const double enough = newton_part * control_.tolerance * y_.norm();
  bool fresh = step != step_factorized_;
  double last = 0.0;
  a_end_ = a_;
  for (int i = 0; i < alpha_newton_steps_max; ++i) {
    place_end(step);
    stage_ = (1.0 - alpha_f_) * end_ + alpha_f_ * y_;
    const Eigen::VectorXd residual =
        acceleration(t, stage_) - (1.0 - alpha_m_) * a_end_ - alpha_m_ * a_;
    if (i == 0 && fresh) factorize(t, stage_, step);
    Eigen::VectorXd change = newton_.solve(residual);
    if (i > 0 && !fresh && change.norm() > contraction * last) {
      factorize(t, stage_, step);
      change = newton_.solve(residual);
      fresh = true;
    }
    a_end_ += change;
    last = change.norm();
    if (!std::isfinite(last)) return false;
    if (step * last > enough) continue;
    place_end(step);
    return true;
  }
  return false;
}

/// Error of a step over the tolerance; infinite when Newton's method fails. The displacement that
/// is exact to third order has 1/6 in place of beta.
double GeneralisedAlpha::try_step(double step)
{
  if (!solve(step)) return std::numeric_limits<double>::infinity();
  const double error =
      std::abs(beta_ - 1.0 / 6.0) * step * step * motion_.omega().cwiseProduct(a_end_ - a_).norm();
  const double scale = control_.tolerance * std::max(y_.norm(), end_.norm());
  return error == 0.0 ? 0.0 : error / scale;
}

void GeneralisedAlpha::advance()
{
  for (;;) {
    const double step = std::min(step_next_, control_.step_max);
    if (step < step_underflow * control_.step_max || !(y_.norm() < state_max)) {
      y_.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const double error = try_step(step);
    if (!(error <= 1.0)) {
      const double factor =
          std::isfinite(error) ? alpha_safety * std::cbrt(1.0 / error) : alpha_shrink_max;
      step_next_ = step * std::max(alpha_shrink_max, factor);
      error_held_ = 1.0;
      ++cost_.n_rejected;
      continue;
    }
    error_held_ = std::max(error, forgetting * error_held_);
    const double factor = std::min(alpha_grow_max, alpha_safety * std::cbrt(1.0 / error_held_));
    begin_ = std::exchange(y_, end_);
    a_begin_ = std::exchange(a_, a_end_);
    t_ += step;
    step_ = step;
    step_next_ = factor > worth_growing ? factor * step : step;
    if (factor > worth_growing) error_held_ = 0.0;
    ++cost_.n_steps;
    return;
  }
}

}  // namespace chladni::squeal
