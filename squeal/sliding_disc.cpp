#include "squeal/sliding_disc.hpp"

#include <fmt/format.h>

#include <array>
#include <complex>
#include <span>
#include <utility>

#include "common/error.hpp"
#include "squeal/derivative.hpp"
#include "squeal/dop853.hpp"
#include "squeal/root.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

/// Branch changes within one step beyond which the motion is taken for chatter.
constexpr int changes_max = 64;
/// Of the time of a branch change, relative. The force is continuous there, so that x is wrong by
/// its square and the derivative by its first power.
constexpr double change_error = 1e-8;

/// The branch g of the contact law for one pad: the signed law with the friction g mu, or nothing.
template <class Scalar>
PadState<Scalar> pad_on_branch(PadContact pad, const RingMotion<Scalar>& m, double speed,
                               const std::array<double, 2>& sigma_and_g)
{
  const auto [sigma, g] = sigma_and_g;
  pad.law = ContactLaw::signed_force;
  pad.friction = scaled(pad.friction, g);
  PadState<Scalar> state = pad_state(pad, m, speed, sigma);
  if (g == 0.0) state.S = state.f_r = state.f_t = Scalar(0.0);
  return state;
}

template <class Scalar>
PairVector<Scalar> force_on_branch(const SlidingDisc::Point& point, const RingMotion<Scalar>& m,
                                   double speed, std::span<const double> branches)
{
  const auto up = pad_on_branch(point.contact, m, speed, {1.0, branches[0]});
  const auto lo = pad_on_branch(point.contact, m, speed, {-1.0, branches[1]});
  return pair_forces(pair_force(point.contact, m, up, lo), up, lo, point.at_rest,
                     static_cast<int>(point.S.cols()));
}

/// Derivatives of the force by the motion of the point and by its rates, by complex steps.
Eigen::MatrixXd force_derivative(const SlidingDisc::Point& point, const PairVector<double>& g,
                                 const PairVector<double>& g_dot,
                                 const std::pair<double, std::span<const double>>& at)
{
  using Complex = std::complex<double>;
  const Eigen::Index rows = g.size();
  Eigen::MatrixXd D(rows, 2 * rows);
  for (Eigen::Index j = 0; j < 2 * rows; ++j) {
    PairVector<Complex> x = g.cast<Complex>(), v = g_dot.cast<Complex>();
    (j < rows ? x[j] : v[j - rows]) += Complex(0.0, complex_step);
    D.col(j) = force_on_branch<Complex>(point, pair_motion(x, v), at.first, at.second).imag() /
               complex_step;
  }
  return D;
}

SquealOptions without_pads(SquealOptions options)
{
  options.pads.clear();
  return options;
}

}  // namespace

SlidingDisc::SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      pulled_(options.contact == ContactLaw::unilateral ? 0.0 : -1.0),
      pads_(pad_system(options, disc.radius)),
      by_omega_(with_pads(disc, pads_).omega.cwiseInverse()),
      A_(state_matrix(with_pads(disc, pads_), without_pads(options), speed))
{
  for (const PointPair& point : pads_.points)
    points_.push_back({.contact = point.contact,
                       .S = pair_shapes(matrix_of(shapes_at(disc, point.angle)), pads_, point),
                       .at_rest = pad_state(point.contact, RingMotion<double>{}, speed, 1.0)});
}

SlidingDisc::PointMotion SlidingDisc::motion_at(const Point& point, const Eigen::VectorXd& x) const
{
  const Eigen::Index n = by_omega_.size();
  return {.g = point.S.transpose() * by_omega_.cwiseProduct(x.head(n)),
          .g_dot = point.S.transpose() * x.tail(n)};
}

ContactResult<double> SlidingDisc::first_contact(const Eigen::VectorXd& x) const
{
  std::vector<ContactResult<double>> results;
  for (const Point& point : points_) {
    const PointMotion at = motion_at(point, x);
    results.push_back(contact(point.contact, pair_motion(at.g, at.g_dot), speed_));
  }
  return by_pad(pads_, results).front();
}

/// S of each pad, of either sign.
Eigen::VectorXd SlidingDisc::axial_forces(const Eigen::VectorXd& x)
{
  ++n_evaluations_;
  Eigen::VectorXd S(static_cast<Eigen::Index>(2 * points_.size()));
  Eigen::Index i = 0;
  for (const Point& point : points_) {
    const PointMotion at = motion_at(point, x);
    const RingMotion<double> motion = pair_motion(at.g, at.g_dot);
    for (const double sigma : {1.0, -1.0})
      S[i++] = pad_on_branch(point.contact, motion, speed_, {sigma, 1.0}).S;
  }
  return S;
}

SlidingDisc::Branches SlidingDisc::branches_at(const Eigen::VectorXd& x)
{
  Branches branches(2 * points_.size(), 1.0);
  if (points_.empty() || points_.front().contact.law == ContactLaw::signed_force) return branches;
  const Eigen::VectorXd S = axial_forces(x);
  for (std::size_t i = 0; i < branches.size(); ++i)
    if (S[static_cast<Eigen::Index>(i)] < 0.0) branches[i] = pulled_;
  return branches;
}

/// (f(x), f'(x) X) of Y = (x, X).
Eigen::MatrixXd SlidingDisc::field(const Eigen::MatrixXd& Y, const Branches& branches)
{
  const Eigen::Index n = by_omega_.size(), n_columns = Y.cols() - 1;
  n_evaluations_ += n_columns > 0 ? 7 : 1;
  Eigen::MatrixXd rate = A_ * Y;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& point = points_[i];
    const PointMotion at = motion_at(point, Y.col(0));
    const std::span<const double> of_pad = std::span(branches).subspan(2 * i, 2);
    const Eigen::Index rows = point.S.cols();
    Eigen::MatrixXd F(rows, Y.cols());
    F.col(0) = force_on_branch(point, pair_motion(at.g, at.g_dot), speed_, of_pad);
    if (n_columns > 0) {
      Eigen::MatrixXd G(2 * rows, n_columns);
      G << point.S.transpose() * by_omega_.asDiagonal() * Y.topRightCorner(n, n_columns),
          point.S.transpose() * Y.bottomRightCorner(n, n_columns);
      F.rightCols(n_columns) = force_derivative(point, at.g, at.g_dot, {speed_, of_pad}) * G;
    }
    rate.bottomRows(n) += point.S * F;
  }
  return rate;
}

/// The first pad whose force changes its sign on the way from `x` to `end`.
std::optional<SlidingDisc::Change> SlidingDisc::first_change(const Eigen::VectorXd& x,
                                                             const Eigen::VectorXd& end,
                                                             double step, const Branches& branches)
{
  std::optional<Change> first;
  if (points_.empty() || points_.front().contact.law == ContactLaw::signed_force) return first;
  const Eigen::VectorXd S_end = axial_forces(end);
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double side = branches[i] == 1.0 ? 1.0 : -1.0;
    if (side * S_end[at] >= 0.0) continue;
    const auto passed = [&](double time) {
      const auto f = [&](const Eigen::MatrixXd& Y) { return field(Y, branches); };
      return -side * axial_forces(dop853_step(f, Eigen::MatrixXd(x), time).col(0))[at];
    };
    // Rounding may leave a pad that has just changed a little on its old side.
    const double after =
        side * axial_forces(x)[at] > 0.0 ? root(passed, 0.0, step, change_error) : 0.0;
    if (!first || after < first->after) first = Change{i, after};
  }
  return first;
}

Eigen::MatrixXd SlidingDisc::advance_over(Eigen::MatrixXd Y, double step, Branches& branches)
{
  for (int i = 0; i < changes_max; ++i) {
    const auto f = [&](const Eigen::MatrixXd& at) { return field(at, branches); };
    const Eigen::MatrixXd end = dop853_step(f, Y, step);
    const auto change = first_change(Y.col(0), end.col(0), step, branches);
    if (!change) return end;
    if (change->after > 0.0) Y = dop853_step(f, Y, change->after);
    branches[change->pad] = branches[change->pad] == 1.0 ? pulled_ : 1.0;
    step -= change->after;
  }
  throw Error(
      fmt::format("the contact of a pad changes more than {} times in {} s", changes_max, step));
}

Eigen::MatrixXd SlidingDisc::integrate(Eigen::MatrixXd Y, double time, int n_steps)
{
  Branches branches = branches_at(Y.col(0));
  for (int i = 0; i < n_steps; ++i) Y = advance_over(std::move(Y), time / n_steps, branches);
  return Y;
}

Eigen::VectorXd SlidingDisc::rate(const Eigen::VectorXd& x)
{
  return field(x, branches_at(x));
}

Eigen::VectorXd SlidingDisc::advance(const Eigen::VectorXd& x, double time, int n_steps)
{
  return integrate(x, time, n_steps);
}

SlidingDisc::Flow SlidingDisc::flow(const Eigen::VectorXd& x, double time, int n_steps)
{
  Eigen::MatrixXd Y(size(), size() + 1);
  Y << x, Eigen::MatrixXd::Identity(size(), size());
  const Eigen::MatrixXd end = integrate(std::move(Y), time, n_steps);
  return {end.col(0), end.rightCols(size())};
}

}  // namespace chladni::squeal
