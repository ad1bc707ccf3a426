#include "squeal/motion/exponential_flow.hpp"

#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "squeal/brake/point_shapes.hpp"
#include "squeal/brake/state_matrix.hpp"

namespace chladni::squeal {

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

}  // namespace chladni::squeal
