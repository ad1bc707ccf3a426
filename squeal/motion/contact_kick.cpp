#include "squeal/motion/contact_kick.hpp"

namespace chladni::squeal {

ContactKick::ContactKick(const Disc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      G_(disc.G.isZero(0.0) ? Eigen::MatrixXd() : disc.G),
      rings_(disc.rings.begin(), disc.rings.end()),
      pads_(pad_system(options, ring_places(disc))),
      position_(pads_.points.size()),
      series_(disc.compliance, pads_, speed),
      motions_(pads_.points.size()),
      contacts_(pads_.points.size()),
      Q_(disc.n_modes() + pads_.n_modes()),
      v_mid_(Q_.size())
{
  for (const PointPair& point : pads_.points) {
    shapes_.push_back(pair_shapes(rings_[point.ring].at(point.angle), pads_, point));
    at_rest_.push_back(pad_state(point.contact, RingMotion<double>{}, speed, 1.0));
  }
}

const std::vector<ContactResult<double>>& ContactKick::apply(ModalState& x, const Turn& turn,
                                                             double step)
{
  speed_ = turn.speed;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const PointPair& point = pads_.points[i];
    const Eigen::MatrixX3d& S = rings_[point.ring].at(point.angle - turn.angle);
    shapes_[i].topLeftCorner(S.rows(), 3) = S;
    position_[i].noalias() = shapes_[i].transpose() * x.q;
  }
  v_mid_ = x.v + 0.5 * step * force(x.v);
  x.v += step * force(v_mid_);
  of_pads_ = by_pad(pads_, contacts_);
  return of_pads_;
}

Eigen::MatrixXd ContactKick::contact_stiffness() const
{
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(Q_.size(), Q_.size());
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const PairShapes& S = shapes_[i];
    K -= S * pair_derivatives(pads_.points[i].contact, speed_, static_cast<int>(S.cols())).D_a *
         S.transpose();
  }
  return K;
}

const Eigen::VectorXd& ContactKick::force(const Eigen::VectorXd& v)
{
  Q_.setZero();
  if (G_.size() > 0) Q_.head(G_.rows()).noalias() -= 2.0 * speed_ * (G_ * v.head(G_.rows()));
  const auto at_point = [&](std::size_t i, const PointMotion& at) {
    return contact(pads_.points[i].contact, pair_motion(at.g, at.g_dot), speed_);
  };
  for (std::size_t i = 0; i < shapes_.size(); ++i)
    motions_[i] = {position_[i], shapes_[i].transpose() * v};
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) -> Eigen::Vector3d {
    const auto force = at_point(i, at).force;
    return {force.F_w, force.F_r, force.F_t};
  });
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    contacts_[i] = at_point(i, motions_[i]);
    Q_.noalias() +=
        shapes_[i] * pair_forces(contacts_[i].force, contacts_[i].upper, contacts_[i].lower,
                                 at_rest_[i], static_cast<int>(shapes_[i].cols()));
  }
  return Q_;
}

}  // namespace chladni::squeal
