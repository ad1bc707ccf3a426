#include "squeal/exponential_flow.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include "squeal/pads.hpp"
#include "squeal/stability.hpp"

namespace chladni::squeal {

ExponentialFlow::ExponentialFlow(const InertialDisc& disc, const SquealOptions& options,
                                 double speed, double step)
    : speed_(speed),
      step_(step),
      position_(options.pads.size()),
      contacts_(options.pads.size()),
      next_(2 * disc.n_modes()),
      p_mid_(disc.n_modes())
{
  const Eigen::MatrixXd A = state_matrix(disc, options, speed);
  half_ = (0.5 * step * A).exp();
  whole_ = half_ * half_;
  for (const PadPair& pad : options.pads) {
    const PadContact contact = pad_contact(options, pad, disc.radius);
    const ContactDerivatives D = contact_derivatives(contact, speed);
    const Shapes shapes = shapes_at(disc, pad.angle);
    Eigen::MatrixX3d S(disc.n_modes(), 3);
    S << shapes.W, shapes.W_r, shapes.W_t;
    pads_.push_back({contact, S, disc.omega.cwiseInverse().asDiagonal() * S, D.D_a, D.D_p});
  }
}

void ExponentialFlow::advance(Eigen::VectorXd& x)
{
  next_.noalias() = whole_ * x;
  x.swap(next_);
}

/// Force of the pair i on its ring without its linear part.
Eigen::Vector3d ExponentialFlow::remainder(std::size_t i, const Eigen::VectorXd& p)
{
  const Pad& pad = pads_[i];
  const Eigen::Vector3d& g = position_[i];
  const Eigen::Vector3d rate = pad.S.transpose() * p;
  contacts_[i] =
      contact(pad.contact, RingMotion<double>{g[0], g[1], g[2], rate[0], rate[1], rate[2]}, speed_);
  const RingForce<double>& F = contacts_[i].force;
  return Eigen::Vector3d{F.F_w, F.F_r, F.F_t} - pad.D_a * g - pad.D_p * rate;
}

const std::vector<ContactResult<double>>& ExponentialFlow::kick(Eigen::VectorXd& x)
{
  const Eigen::Index n = p_mid_.size();
  for (std::size_t i = 0; i < pads_.size(); ++i)
    position_[i].noalias() = pads_[i].S_by_omega.transpose() * x.head(n);
  p_mid_ = x.tail(n);
  for (std::size_t i = 0; i < pads_.size(); ++i)
    p_mid_.noalias() += pads_[i].S * (0.5 * step_ * remainder(i, x.tail(n)));
  for (std::size_t i = 0; i < pads_.size(); ++i)
    x.tail(n).noalias() += pads_[i].S * (step_ * remainder(i, p_mid_));
  return contacts_;
}

}  // namespace chladni::squeal
