#include "squeal/motion/dormand_prince.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "squeal/motion/dop853.hpp"
#include "squeal/numerics.hpp"

namespace chladni::squeal {
namespace {

constexpr double safety = 0.9, shrink_max = 0.2, grow_max = 6.0;
/// Changes of side at one time beyond which the motion is taken for chatter.
constexpr int stuck_steps_max = 64;
/// Parts of a step at which switching functions are looked at.
constexpr int parts_of_step = 8;
/// A switching function whose stages stay above this part of their range does not cross zero.
constexpr double far_from_zero = 0.25;
/// Of the time of a crossing, relative to the step.
constexpr double crossing_error = 1e-10;

/// Vertex of the parabola through three samples, in units of their distance from the middle one.
double vertex(double left, double middle, double right)
{
  const double bend = left - 2.0 * middle + right;
  return bend > 0.0 ? 0.5 * (left - right) / bend : 0.0;
}

}  // namespace

DormandPrince::DormandPrince(SwitchedMotion& motion, double t, const Eigen::VectorXd& y,
                             const StepControl& control)
    : motion_(motion),
      control_(control),
      t_(t),
      t_begin_(t),
      step_(0.0),
      step_next_(control.step_first),
      y_(y),
      begin_(y),
      end_(y),
      stage_(y),
      sample_(y),
      K_(y.size(), 16),
      dense_(y.size(), 7)
{
  motion_.take_sides(t, y);
  s_.resize(motion_.switches().size(), 16);
}

const Eigen::VectorXd& DormandPrince::at(double t)
{
  while (t_ < t && y_.allFinite()) advance();
  if (t >= t_ || step_ == 0.0) return y_;
  if (!extended_) extend();
  return interpolated((t - t_begin_) / step_);
}

DormandPrince::Span DormandPrince::next_step()
{
  const double before = t_;
  advance();
  return {before, t_};
}

const Eigen::VectorXd& DormandPrince::slope(int stage, const Eigen::VectorXd& y)
{
  const double t = t_begin_ + dop853_c[static_cast<std::size_t>(stage)] * step_;
  const Eigen::VectorXd& f = motion_.rate(t, y);
  if (s_.rows() > 0) s_.col(stage) = motion_.switches();
  return f;
}

/// All stages of a step from `begin_`; its error over the tolerance.
double DormandPrince::try_step(double step)
{
  step_ = step;
  extended_ = false;
  auto coefficient = dop853_a.begin();
  for (int i = 1; i < dop853_stages; ++i) {
    stage_ = begin_;
    for (; coefficient != dop853_a.end() && coefficient->stage == i; ++coefficient)
      stage_ += (step * coefficient->a) * K_.col(coefficient->from);
    K_.col(i) = slope(i, stage_);
  }
  using Weights = Eigen::Map<const Eigen::Matrix<double, dop853_stages, 1>>;
  const auto stages = K_.leftCols<dop853_stages>();
  end_.noalias() = begin_ + step * (stages * Weights(dop853_b.data()));
  const double error_3 = (stages * Weights(dop853_e3.data())).squaredNorm();
  const double error_5 = (stages * Weights(dop853_e5.data())).squaredNorm();
  const double scale = control_.tolerance * std::max(begin_.norm(), end_.norm());
  if (error_5 == 0.0) return 0.0;
  return step * error_5 / std::sqrt(error_5 + 0.01 * error_3) / scale;
}

void DormandPrince::advance()
{
  begin_ = y_;
  t_begin_ = t_;
  K_.col(0) = knows_slope_ ? K_.col(12).eval() : slope(0, begin_);
  if (knows_slope_) s_.col(0) = s_.col(12).eval();
  for (;;) {
    const double step = std::min(step_next_, control_.step_max);
    if (step < step_underflow * control_.step_max || !(y_.norm() < state_max)) {
      y_.setConstant(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const double error = try_step(step);
    if (!(error <= 1.0)) {
      const double factor = std::isfinite(error) ? safety * std::pow(error, -0.125) : shrink_max;
      step_next_ = step * std::max(shrink_max, factor);
      ++cost_.n_rejected;
      continue;
    }
    K_.col(12) = slope(12, end_);
    if (const auto crossing = first_crossing()) return cross(*crossing, step);
    accept(step);
    step_next_ = step * std::clamp(safety * std::pow(error, -0.125), shrink_max, grow_max);
    return;
  }
}

/// The step under trial becomes the last one; its slope at the end is kept in stage 12.
void DormandPrince::accept(double step)
{
  y_ = end_;
  t_ = t_begin_ + step;
  ++cost_.n_steps;
  n_stuck_ = 0;
  knows_slope_ = true;
}

/// Ends the step where a switching function is zero and changes its side there.
void DormandPrince::cross(const Crossing& crossing, double step)
{
  const double side = -motion_.side(crossing.i);
  if (crossing.fraction > 0.0) {
    try_step(crossing.fraction * step);
    accept(crossing.fraction * step);
    K_.col(12) = slope(12, end_);
    extend();
    step_next_ = step;
  } else if (++n_stuck_ > stuck_steps_max) {
    throw StuckContact(fmt::format(
        "the contact of a pad changes more than {} times at t = {:.9g} s; give the pads "
        "some damping, or take integrator = \"splitting\"",
        stuck_steps_max, t_));
  }
  motion_.set_side(crossing.i, side);
  if (events_.size() < events_max) events_.push_back({t_, crossing.i, side});
  ++cost_.n_events;
  knows_slope_ = false;
}

void DormandPrince::extend()
{
  auto coefficient = dop853_a_dense.begin();
  for (int i = 13; i < 16; ++i) {
    stage_ = begin_;
    for (; coefficient != dop853_a_dense.end() && coefficient->stage == i; ++coefficient)
      stage_ += (step_ * coefficient->a) * K_.col(coefficient->from);
    K_.col(i) = slope(i, stage_);
  }
  dense_.col(0) = end_ - begin_;
  dense_.col(1) = step_ * K_.col(0) - dense_.col(0);
  dense_.col(2) = 2.0 * dense_.col(0) - step_ * (K_.col(12) + K_.col(0));
  for (int i = 0; i < 4; ++i) {
    dense_.col(3 + i).noalias() = step_ * (K_ * Eigen::Map<const Eigen::Matrix<double, 16, 1>>(
                                                    dop853_d[static_cast<std::size_t>(i)].data()));
  }
  extended_ = true;
}

const Eigen::VectorXd& DormandPrince::interpolated(double x)
{
  sample_ = x * dense_.col(6);
  for (int i = 5; i >= 0; --i) {
    sample_ += dense_.col(i);
    sample_ *= i % 2 == 0 ? x : 1.0 - x;
  }
  sample_ += begin_;
  return sample_;
}

double DormandPrince::switch_at(Eigen::Index i, double fraction)
{
  motion_.rate(t_begin_ + fraction * step_, interpolated(fraction));
  return motion_.switches()[i];
}

std::optional<DormandPrince::Crossing> DormandPrince::first_crossing()
{
  const auto may_cross = [&](Eigen::Index i) {
    const Eigen::ArrayXd s = motion_.side(i) * s_.row(i).head(13).transpose().array();
    const double low = s.minCoeff();
    return low < far_from_zero * (s.maxCoeff() - low);
  };
  Eigen::MatrixXd samples;
  std::optional<Crossing> first;
  for (Eigen::Index i = 0; i < s_.rows(); ++i) {
    if (!may_cross(i)) continue;
    if (samples.size() == 0) {
      extend();
      samples.resize(s_.rows(), parts_of_step + 1);
      samples.col(0) = s_.col(0);
      samples.col(parts_of_step) = s_.col(12);
      for (int k = 1; k < parts_of_step; ++k) {
        motion_.rate(t_begin_ + step_ * k / parts_of_step, interpolated(double(k) / parts_of_step));
        samples.col(k) = motion_.switches();
      }
    }
    const auto fraction = crossing_of(i, samples);
    if (fraction && (!first || *fraction < first->fraction)) first = Crossing{i, *fraction};
  }
  return first;
}

/// Where the function i leaves its side first, as a fraction of the step.
std::optional<double> DormandPrince::crossing_of(Eigen::Index i, const Eigen::MatrixXd& samples)
{
  const Eigen::VectorXd s = motion_.side(i) * samples.row(i).transpose();
  const auto passed = [&](double x) { return -motion_.side(i) * switch_at(i, x); };
  double inside = -1.0;  // the last fraction at which the function was on its side
  for (int k = 0; k <= parts_of_step; ++k) {
    const double x = double(k) / parts_of_step;
    if (k > 0 && s[k] < 0.0) return inside < 0.0 ? 0.0 : root(passed, inside, x, crossing_error);
    if (s[k] > 0.0) inside = x;
    if (k == 0 || k == parts_of_step || s[k] > s[k - 1] || s[k] > s[k + 1] || inside < 0.0)
      continue;
    // A minimum on its side: between the samples the function may be on the other one.
    const double lowest = x + vertex(s[k - 1], s[k], s[k + 1]) / parts_of_step;
    if (passed(lowest) > 0.0) {
      const double before = lowest > x ? x : double(k - 1) / parts_of_step;
      return s[k - 1] > 0.0 || lowest > x ? root(passed, before, lowest, crossing_error) : 0.0;
    }
  }
  return std::nullopt;
}

}  // namespace chladni::squeal
