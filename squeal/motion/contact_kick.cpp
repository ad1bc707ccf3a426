#include "squeal/motion/contact_kick.hpp"

namespace chladni::squeal {

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

}  // namespace chladni::squeal
