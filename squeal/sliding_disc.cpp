#include "squeal/sliding_disc.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <utility>

#include "common/error.hpp"
#include "squeal/contact_branch.hpp"
#include "squeal/dop853.hpp"
#include "squeal/pads.hpp"
#include "squeal/root.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {
namespace {

/// Branch changes within one step beyond which the motion is taken for chatter.
constexpr int changes_max = 64;
/// Of the time of a branch change, relative. The force is continuous there, so that x is wrong by
/// its square and the derivative by its first power.
constexpr double change_error = 1e-8;

SquealOptions without_pads(SquealOptions options)
{
  options.pads.clear();
  return options;
}

}  // namespace

SlidingDisc::SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      pulled_(pulled_branch(options.contact)),
      by_omega_(disc.omega.cwiseInverse()),
      A_(state_matrix(disc, without_pads(options), speed))
{
  for (const PadPair& pad : options.pads) {
    const Shapes shapes = shapes_at(disc, pad.angle);
    Eigen::MatrixX3d S(disc.n_modes(), 3);
    S << shapes.W, shapes.W_r, shapes.W_t;
    pads_.push_back({pad_contact(options, pad, disc.radius), S});
  }
}

RingMotion<double> SlidingDisc::motion_at(const Pad& pad, const Eigen::VectorXd& x) const
{
  const Eigen::Index n = by_omega_.size();
  const Eigen::Vector3d g = pad.S.transpose() * by_omega_.cwiseProduct(x.head(n));
  const Eigen::Vector3d g_dot = pad.S.transpose() * x.tail(n);
  return {g[0], g[1], g[2], g_dot[0], g_dot[1], g_dot[2]};
}

ContactResult<double> SlidingDisc::first_contact(const Eigen::VectorXd& x) const
{
  return contact(pads_.front().contact, motion_at(pads_.front(), x), speed_);
}

/// The normal force alone acts with N / s along the axis and sigma N g / s in the plane; the rest
/// of the force is friction.
SlidingDisc::Power SlidingDisc::power(const Eigen::VectorXd& x) const
{
  const auto n_pads = static_cast<Eigen::Index>(pads_.size());
  const Eigen::Index n = by_omega_.size();
  const auto p = x.tail(n);
  Power power{Eigen::VectorXd(n_pads), Eigen::VectorXd(n_pads), Eigen::VectorXd(n_pads),
              p.dot(A_.bottomRightCorner(n, n) * p)};
  for (Eigen::Index i = 0; i < n_pads; ++i) {
    const Pad& pad = pads_[static_cast<std::size_t>(i)];
    const RingMotion<double> m = motion_at(pad, x);
    const ContactResult<double> all = contact(pad.contact, m, speed_);
    const double s = std::sqrt(1.0 + m.g_r * m.g_r + m.g_t * m.g_t);
    const auto normal_of = [&](PadState<double> state, double sigma) {
      state.S = state.N / s;
      state.f_r = sigma * state.N * m.g_r / s;
      state.f_t = sigma * state.N * m.g_t / s;
      return state;
    };
    const auto power_of = [&](const RingForce<double>& F) {
      return F.F_w * m.w_dot + F.F_r * m.g_r_dot + F.F_t * m.g_t_dot;
    };
    const auto heat_of = [&](const PadState<double>& state) {
      const FrictionLaw& law = pad.contact.friction;
      const double v = regularised_speed(law, state.slip_speed * state.slip_speed);
      const double g = pad.contact.law == ContactLaw::signed_force ? state.N : std::abs(state.N);
      return friction_coefficient(law, v) * g * state.slip_speed * state.slip_speed / v;
    };
    power.normal[i] =
        power_of(pair_force(pad.contact, m, normal_of(all.upper, 1.0), normal_of(all.lower, -1.0)));
    power.friction[i] = power_of(all.force) - power.normal[i];
    power.heat[i] = heat_of(all.upper) + heat_of(all.lower);
  }
  return power;
}

/// S of each pad, of either sign.
Eigen::VectorXd SlidingDisc::axial_forces(const Eigen::VectorXd& x)
{
  ++n_evaluations_;
  Eigen::VectorXd S(static_cast<Eigen::Index>(2 * pads_.size()));
  Eigen::Index i = 0;
  for (const Pad& pad : pads_) {
    const RingMotion<double> motion = motion_at(pad, x);
    for (const double sigma : {1.0, -1.0})
      S[i++] = pad_on_branch(pad.contact, motion, speed_, {sigma, 1.0}).S;
  }
  return S;
}

SlidingDisc::Branches SlidingDisc::branches_at(const Eigen::VectorXd& x)
{
  Branches branches(2 * pads_.size(), 1.0);
  if (pads_.empty() || pads_.front().contact.law == ContactLaw::signed_force) return branches;
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
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const Pad& pad = pads_[i];
    const RingMotion<double> motion = motion_at(pad, Y.col(0));
    const std::span<const double> of_pad = std::span(branches).subspan(2 * i, 2);
    Eigen::Matrix3Xd F(3, Y.cols());
    F.col(0) = force_on_branch(pad.contact, motion, speed_, of_pad);
    if (n_columns > 0) {
      Eigen::Matrix<double, 6, Eigen::Dynamic> G(6, n_columns);
      G << pad.S.transpose() * by_omega_.asDiagonal() * Y.topRightCorner(n, n_columns),
          pad.S.transpose() * Y.bottomRightCorner(n, n_columns);
      F.rightCols(n_columns) = force_derivative(pad.contact, motion, speed_, of_pad) * G;
    }
    rate.bottomRows(n) += pad.S * F;
  }
  return rate;
}

/// The first pad whose force changes its sign on the way from `x` to `end`.
std::optional<SlidingDisc::Change> SlidingDisc::first_change(const Eigen::VectorXd& x,
                                                             const Eigen::VectorXd& end,
                                                             double step, const Branches& branches)
{
  std::optional<Change> first;
  if (pads_.empty() || pads_.front().contact.law == ContactLaw::signed_force) return first;
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
