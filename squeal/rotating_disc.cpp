#include "squeal/rotating_disc.hpp"

#include "squeal/contact_branch.hpp"
#include "squeal/pads.hpp"

namespace chladni::squeal {

RotatingDisc::RotatingDisc(const Disc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      pulled_(pulled_branch(options.contact)),
      omega_(disc.omega),
      C_(disc.C),
      damped_(!disc.C.isZero(0.0)),
      ring_(disc),
      branches_(2 * options.pads.size(), 1.0),
      S_(options.contact == ContactLaw::signed_force
             ? Eigen::VectorXd()
             : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(branches_.size()))),
      f_(2 * disc.n_modes()),
      q_(disc.n_modes())
{
  for (const PadPair& pad : options.pads) {
    pads_.push_back(pad_contact(options, pad, disc.radius));
    angles_.push_back(pad.angle);
  }
}

const Eigen::MatrixX3d& RotatingDisc::shapes(std::size_t i, double t)
{
  return ring_.at(angles_[i] - speed_ * t);
}

RingMotion<double> RotatingDisc::ring_motion(const Eigen::MatrixX3d& S, const Eigen::VectorXd& y)
{
  const Eigen::Index n = omega_.size();
  q_ = y.head(n).cwiseQuotient(omega_);
  const Eigen::Vector3d g = S.transpose() * q_, g_dot = S.transpose() * y.tail(n);
  return {g[0], g[1], g[2], g_dot[0], g_dot[1], g_dot[2]};
}

/// f = (diag(omega) v, -diag(omega) (omega q) - C v + sum_pads S F)
const Eigen::VectorXd& RotatingDisc::rate(double t, const Eigen::VectorXd& y)
{
  const Eigen::Index n = omega_.size();
  ++n_evaluations_;
  f_.head(n) = omega_.cwiseProduct(y.tail(n));
  f_.tail(n) = -omega_.cwiseProduct(y.head(n));
  if (damped_) f_.tail(n).noalias() -= C_ * y.tail(n);
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const Eigen::MatrixX3d& S = shapes(i, t);
    const RingMotion<double> motion = ring_motion(S, y);
    // Off its contact a pad has no force; its switching function is what it would press with.
    const auto up = pad_on_branch(pads_[i], motion, speed_, {1.0, branches_[2 * i]});
    const auto lo = pad_on_branch(pads_[i], motion, speed_, {-1.0, branches_[2 * i + 1]});
    if (S_.size() > 0) {
      const auto at = static_cast<Eigen::Index>(2 * i);
      const PadContact& pad = pads_[i];
      const auto pressed = [&](const PadState<double>& state, double sigma) {
        const double lift = state.z - sigma * 0.5 * pad.thickness;
        return 1.0 + sigma * (force(pad.spring, lift) + pad.damping * state.z_dot) / pad.preload;
      };
      S_[at] = pressed(up, 1.0);
      S_[at + 1] = pressed(lo, -1.0);
    }
    const RingForce<double> F = pair_force(pads_[i], motion, up, lo);
    f_.tail(n).noalias() += S * Eigen::Vector3d{F.F_w, F.F_r, F.F_t};
  }
  return f_;
}

double RotatingDisc::side(Eigen::Index i) const
{
  return branches_[static_cast<std::size_t>(i)] == 1.0 ? 1.0 : -1.0;
}

void RotatingDisc::set_side(Eigen::Index i, double side)
{
  branches_[static_cast<std::size_t>(i)] = side > 0.0 ? 1.0 : pulled_;
}

Motion::Tangent RotatingDisc::tangent(double t, const Eigen::VectorXd& y)
{
  const Eigen::VectorXd squares = omega_.cwiseAbs2();
  n_evaluations_ += 6;
  Tangent d{-squares.asDiagonal().toDenseMatrix(), -C_};
  for (std::size_t i = 0; i < pads_.size(); ++i) {
    const Eigen::MatrixX3d S = shapes(i, t);
    const Eigen::Matrix<double, 3, 6> D = force_derivative(pads_[i], ring_motion(S, y), speed_,
                                                           std::span(branches_).subspan(2 * i, 2));
    d.by_q += S * D.leftCols<3>() * S.transpose();
    d.by_v += S * D.rightCols<3>() * S.transpose();
  }
  return d;
}

std::vector<ContactResult<double>> RotatingDisc::contacts(double t, const Eigen::VectorXd& y)
{
  std::vector<ContactResult<double>> results;
  for (std::size_t i = 0; i < pads_.size(); ++i)
    results.push_back(contact(pads_[i], ring_motion(shapes(i, t), y), speed_));
  return results;
}

}  // namespace chladni::squeal
