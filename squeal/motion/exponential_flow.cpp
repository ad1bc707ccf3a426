#include "squeal/motion/exponential_flow.hpp"

#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "squeal/brake/state_matrix.hpp"

namespace chladni::squeal {

ExponentialFlow::ExponentialFlow(const InertialDisc& disc, const SquealOptions& options,
                                 double speed, double step)
    : speed_(speed), step_(step), pads_(pad_system(options, ring_places(disc)))
{
  const Eigen::MatrixXd A = state_matrix(disc, options, speed);
  half_ = (0.5 * step * A).exp();
  whole_ = half_ * half_;
  next_.resize(A.rows());
  p_mid_.resize(A.rows() / 2);
  const Eigen::VectorXd omega = with_pads(disc, pads_).omega;
  for (const PointPair& point : pads_.points) {
    BrakePoint at = brake_point(matrix_of(shapes_at(disc, disc.rings[point.ring], point.angle)),
                                pads_, point, speed);
    const PairShapes S_by_omega = omega.cwiseInverse().asDiagonal() * at.S;
    const PairDerivatives D = pair_derivatives(point.contact, speed, static_cast<int>(at.S.cols()));
    points_.push_back({std::move(at), S_by_omega, D});
  }
  position_.resize(points_.size());
  contacts_.resize(points_.size());
}

void ExponentialFlow::advance(Eigen::VectorXd& x)
{
  next_.noalias() = whole_ * x;
  x.swap(next_);
}

/// Force at the point pair i without its linear part.
PairVector<double> ExponentialFlow::remainder(std::size_t i, const Eigen::VectorXd& p)
{
  const Point& point = points_[i];
  const PairVector<double>& g = position_[i];
  const PairVector<double> rate = point.at.S.transpose() * p;
  contacts_[i] = contact(point.at.contact, pair_motion(g, rate), speed_);
  PairVector<double> F = pair_forces(contacts_[i].force, contacts_[i].upper, contacts_[i].lower,
                                     point.at.at_rest, static_cast<int>(g.size()));
  F.noalias() -= point.D.D_a * g;
  F.noalias() -= point.D.D_p * rate;
  return F;
}

const std::vector<ContactResult<double>>& ExponentialFlow::kick(Eigen::VectorXd& x)
{
  const Eigen::Index n = p_mid_.size();
  for (std::size_t i = 0; i < points_.size(); ++i)
    position_[i].noalias() = points_[i].S_by_omega.transpose() * x.head(n);
  p_mid_ = x.tail(n);
  for (std::size_t i = 0; i < points_.size(); ++i)
    p_mid_.noalias() += points_[i].at.S * (0.5 * step_ * remainder(i, x.tail(n)));
  for (std::size_t i = 0; i < points_.size(); ++i)
    x.tail(n).noalias() += points_[i].at.S * (step_ * remainder(i, p_mid_));
  of_pads_ = by_pad(pads_, contacts_);
  return of_pads_;
}

}  // namespace chladni::squeal
