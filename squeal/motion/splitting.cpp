#include "squeal/motion/splitting.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <utility>

#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

namespace {

/// exp(time [0 omega; -omega -C]) acts on (omega q, v), which is well scaled; turned into (q, v).
Eigen::MatrixXd exact_flow(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double time)
{
  const Eigen::Index n = omega.size();
  const Eigen::MatrixXd Omega = omega.asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << Eigen::MatrixXd::Zero(n, n), Omega, -Omega, -C;
  Eigen::MatrixXd flow = (time * A).exp();
  flow.topRightCorner(n, n) = omega.cwiseInverse().asDiagonal() * flow.topRightCorner(n, n);
  flow.bottomLeftCorner(n, n) *= Omega;
  flow.topLeftCorner(n, n) = omega.cwiseInverse().asDiagonal() * flow.topLeftCorner(n, n) * Omega;
  return flow;
}

}  // namespace

OscillatorFlow::OscillatorFlow(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double time)
    : coupled_(!C.isDiagonal(1e-14)), qq_(omega.size()), qv_(qq_), vq_(qq_), vv_(qq_)
{
  if (coupled_) {
    flow_ = exact_flow(omega, C, time);
    return;
  }
  for (Eigen::Index i = 0; i < omega.size(); ++i) {
    const Eigen::Matrix2d block = exact_flow(omega.segment(i, 1), C.block(i, i, 1, 1), time);
    qq_[i] = block(0, 0);
    qv_[i] = block(0, 1);
    vq_[i] = block(1, 0);
    vv_[i] = block(1, 1);
  }
}

void OscillatorFlow::advance(ModalState& x) const
{
  const Eigen::Index n = x.q.size();
  if (coupled_) {
    const Eigen::VectorXd q = flow_.topLeftCorner(n, n) * x.q + flow_.topRightCorner(n, n) * x.v;
    x.v = flow_.bottomLeftCorner(n, n) * x.q + flow_.bottomRightCorner(n, n) * x.v;
    x.q = q;
    return;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double q = x.q[i], v = x.v[i];
    x.q[i] = qq_[i] * q + qv_[i] * v;
    x.v[i] = vq_[i] * q + vv_[i] * v;
  }
}

void OscillatorFlow::advance(ModalColumns& x) const
{
  const Eigen::Index n = x.q.rows();
  if (coupled_) {
    const Eigen::MatrixXd q = flow_.topLeftCorner(n, n) * x.q + flow_.topRightCorner(n, n) * x.v;
    x.v = flow_.bottomLeftCorner(n, n) * x.q + flow_.bottomRightCorner(n, n) * x.v;
    x.q = q;
    return;
  }
  const Eigen::MatrixXd q = qq_.matrix().asDiagonal() * x.q + qv_.matrix().asDiagonal() * x.v;
  x.v = vq_.matrix().asDiagonal() * x.q + vv_.matrix().asDiagonal() * x.v;
  x.q = q;
}

ContactKick::ContactKick(const Disc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      first_speed_(speed),
      G_(disc.G.isZero(0.0) ? Eigen::MatrixXd() : disc.G),
      shapes_(disc),
      pads_(pad_system(options, ring_places(disc))),
      position_(pads_.points.size()),
      series_(disc.compliance, pads_, speed),
      motions_(pads_.points.size()),
      contacts_(pads_.points.size()),
      Q_(disc.n_modes() + pads_.n_modes()),
      v_mid_(Q_.size())
{
  for (const PointPair& point : pads_.points)
    points_.push_back(brake_point(shapes_.at(point, 0.0), pads_, point, speed));
}

const std::vector<ContactResult<double>>& ContactKick::apply(ModalState& x, const Turn& turn,
                                                             double step)
{
  speed_ = turn.speed;
  press(turn.preload);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::MatrixXd& S = shapes_.at(pads_.points[i], turn.angle);
    points_[i].S.topLeftCorner(S.rows(), S.cols()) = S;
    position_[i].noalias() = points_[i].S.transpose() * x.q;
  }
  v_mid_ = x.v + 0.5 * step * force(x.v);
  x.v += step * force(v_mid_);
  of_pads_ = by_pad(pads_, contacts_);
  return of_pads_;
}

void ContactKick::press(double preload)
{
  if (preload == preload_) return;
  preload_ = preload;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    points_[i].contact.preload = preload * pads_.points[i].contact.preload;
    points_[i].at_rest = states_at_rest(points_[i].contact, first_speed_);
  }
}

Eigen::MatrixXd ContactKick::contact_stiffness() const
{
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(Q_.size(), Q_.size());
  for (const BrakePoint& point : points_)
    K -= point.S * pair_derivatives(point.contact, speed_, pads_.rows()).D_a * point.S.transpose();
  return K;
}

const Eigen::VectorXd& ContactKick::force(const Eigen::VectorXd& v)
{
  Q_.setZero();
  if (G_.size() > 0) Q_.head(G_.rows()).noalias() -= 2.0 * speed_ * (G_ * v.head(G_.rows()));
  for (std::size_t i = 0; i < points_.size(); ++i)
    motions_[i] = {position_[i], points_[i].S.transpose() * v};
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) {
    return contact_at(points_[i], at, speed_).force;
  });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PairContact at = contact_at(points_[i], motions_[i], speed_);
    contacts_[i] = at.states;
    Q_.noalias() += points_[i].S * at.force;
  }
  return Q_;
}

ExponentialFlow::ExponentialFlow(const InertialDisc& disc, const SquealOptions& options,
                                 double speed, double step)
    : speed_(speed),
      step_(step),
      pads_(pad_system(options, ring_places(disc))),
      series_(disc.compliance, pads_, speed),
      linear_(linear_contact(disc, pads_, speed))
{
  const Eigen::MatrixXd A = state_matrix(disc, options, speed);
  half_ = (0.5 * step * A).exp();
  whole_ = half_ * half_;
  next_.resize(A.rows());
  p_mid_.resize(A.rows() / 2);
  const Eigen::VectorXd omega = with_pads(disc, pads_).omega;
  for (const PointPair& point : pads_.points) {
    BrakePoint at = brake_point(shapes_at(disc, point), pads_, point, speed);
    const PairShapes S_by_omega = omega.cwiseInverse().asDiagonal() * at.S;
    points_.push_back({std::move(at), S_by_omega});
  }
  position_.resize(points_.size());
  motions_.resize(points_.size());
  contacts_.resize(points_.size());
}

void ExponentialFlow::advance(Eigen::VectorXd& x)
{
  next_.noalias() = whole_ * x;
  x.swap(next_);
}

void ExponentialFlow::add_remainders(const Eigen::VectorXd& p, double factor,
                                     Eigen::Ref<Eigen::VectorXd> to)
{
  linear_force_.setZero(linear_.D_a.rows());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    motions_[i] = {position_[i], points_[i].at.S.transpose() * p};
    const Eigen::Index rows = motions_[i].g.size(), first = rows * static_cast<Eigen::Index>(i);
    linear_force_.noalias() += linear_.D_a.middleCols(first, rows) * motions_[i].g;
    linear_force_.noalias() += linear_.D_p.middleCols(first, rows) * motions_[i].g_dot;
  }
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) {
    return contact_at(points_[i].at, at, speed_).force;
  });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PairContact at = contact_at(points_[i].at, motions_[i], speed_);
    contacts_[i] = at.states;
    const Eigen::Index rows = motions_[i].g.size(), first = rows * static_cast<Eigen::Index>(i);
    const PairVector<double> F = at.force - linear_force_.segment(first, rows);
    to.noalias() += points_[i].at.S * (factor * F);
  }
}

const std::vector<ContactResult<double>>& ExponentialFlow::kick(Eigen::VectorXd& x)
{
  const Eigen::Index n = p_mid_.size();
  for (std::size_t i = 0; i < points_.size(); ++i)
    position_[i].noalias() = points_[i].S_by_omega.transpose() * x.head(n);
  p_mid_ = x.tail(n);
  add_remainders(x.tail(n), 0.5 * step_, p_mid_);
  add_remainders(p_mid_, step_, x.tail(n));
  of_pads_ = by_pad(pads_, contacts_);
  return of_pads_;
}

double preload_at(const TransientCase& run, double t)
{
  const std::vector<PreloadPoint>& points = run.preload_program;
  if (points.empty()) return 1.0;
  const auto next = std::ranges::upper_bound(points, t, {}, &PreloadPoint::time);
  if (next == points.begin()) return points.front().factor;
  if (next == points.end()) return points.back().factor;
  const PreloadPoint& last = *(next - 1);
  const double s = (t - last.time) / (next->time - last.time);
  return (1.0 - s) * last.factor + s * next->factor;
}

namespace {

Turn rotation_at(const TransientCase& run, double t)
{
  if (run.speed_program.empty()) return {.angle = run.speed * t, .speed = run.speed};
  SpeedPoint last{.time = 0.0, .speed = run.speed_program.front().speed};
  double angle = 0.0;
  for (const SpeedPoint& next : run.speed_program) {
    if (next.time <= last.time) continue;
    const double slope = (next.speed - last.speed) / (next.time - last.time);
    const double time = std::min(t, next.time) - last.time;
    angle += (last.speed + 0.5 * slope * time) * time;
    if (t <= next.time) return {.angle = angle, .speed = last.speed + slope * time};
    last = next;
  }
  return {.angle = angle + last.speed * (t - last.time), .speed = last.speed};
}

}  // namespace

Turn turn_at(const TransientCase& run, double t)
{
  Turn turn = rotation_at(run, t);
  turn.preload = preload_at(run, t);
  return turn;
}

}  // namespace chladni::squeal
