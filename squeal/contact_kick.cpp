#include "squeal/contact_kick.hpp"

#include "squeal/pads.hpp"

namespace chladni::squeal {

ContactKick::ContactKick(const Disc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      ring_(disc),
      shapes_(options.pads.size()),
      position_(options.pads.size()),
      contacts_(options.pads.size()),
      Q_(disc.n_modes()),
      v_mid_(disc.n_modes())
{
  for (const PadPair& pad : options.pads) {
    pads_.push_back(pad_contact(options, pad, disc.radius));
    angles_.push_back(pad.angle);
  }
}

const std::vector<ContactResult<double>>& ContactKick::apply(ModalState& x, double t, double step)
{
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    shapes_[i] = ring_.at(angles_[i] - speed_ * t);
    position_[i].noalias() = shapes_[i].transpose() * x.q;
  }
  v_mid_ = x.v + 0.5 * step * force(x.v);
  x.v += step * force(v_mid_);
  return contacts_;
}

const Eigen::VectorXd& ContactKick::force(const Eigen::VectorXd& v)
{
  Q_.setZero();
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const Eigen::Vector3d& g = position_[i];
    const Eigen::Vector3d rate = shapes_[i].transpose() * v;
    contacts_[i] =
        contact(pads_[i], RingMotion<double>{g[0], g[1], g[2], rate[0], rate[1], rate[2]}, speed_);
    const RingForce<double>& F = contacts_[i].force;
    Q_.noalias() += shapes_[i] * Eigen::Vector3d{F.F_w, F.F_r, F.F_t};
  }
  return Q_;
}

}  // namespace chladni::squeal
