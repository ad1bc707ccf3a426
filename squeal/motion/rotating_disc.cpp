#include "squeal/motion/rotating_disc.hpp"

#include <utility>

namespace chladni::squeal {

RotatingDisc::RotatingDisc(const Disc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      contact_(disc.compliance, pad_system(options, ring_places(disc)), options.contact, speed),
      shapes_(disc)
{
  FreeBrake brake = free_brake(disc, contact_.pads(), speed);
  omega_ = std::move(brake.omega);
  C_ = std::move(brake.C);
  damped_ = !C_.isZero(0.0);
  f_.resize(2 * omega_.size());
  q_.resize(omega_.size());
  for (const PointPair& point : contact_.pads().points)
    contact_.points().push_back(brake_point(shapes_.at(point, 0.0), contact_.pads(), point, speed));
}

void RotatingDisc::move_points(double t, const Eigen::VectorXd& y)
{
  const Eigen::Index n = omega_.size();
  q_ = y.head(n).cwiseQuotient(omega_);
  for (std::size_t i = 0; i < contact_.points().size(); ++i) {
    const PointPair& point = contact_.pads().points[i];
    PairShapes& S = contact_.points()[i].S;
    const Eigen::MatrixXd& of_disc = shapes_.at(point, speed_ * t);
    S.topLeftCorner(of_disc.rows(), of_disc.cols()) = of_disc;
    contact_.motions()[i] = {.g = S.transpose() * q_, .g_dot = S.transpose() * y.tail(n)};
  }
}

/// f = (diag(omega) v, -diag(omega) (omega q) - C v + sum_points S F)
const Eigen::VectorXd& RotatingDisc::rate(double t, const Eigen::VectorXd& y)
{
  const Eigen::Index n = omega_.size();
  ++n_evaluations_;
  f_.head(n) = omega_.cwiseProduct(y.tail(n));
  f_.tail(n) = -omega_.cwiseProduct(y.head(n));
  if (damped_) f_.tail(n).noalias() -= C_ * y.tail(n);
  move_points(t, y);
  contact_.add_forces(f_.tail(n));
  return f_;
}

int RotatingDisc::pad_of(Eigen::Index i) const
{
  const std::size_t pair = contact_.pads().points[static_cast<std::size_t>(i / 2)].pad;
  return 2 * static_cast<int>(pair) + static_cast<int>(i % 2);
}

Motion::Tangent RotatingDisc::tangent(double t, const Eigen::VectorXd& y)
{
  const Eigen::VectorXd squares = omega_.cwiseAbs2();
  n_evaluations_ += 6;
  Tangent d{-squares.asDiagonal().toDenseMatrix(), -C_};
  move_points(t, y);
  const StackedContact contact = contact_.derivatives(omega_.size());
  d.by_q += contact.S * contact.D_a * contact.S.transpose();
  d.by_v += contact.S * contact.D_p * contact.S.transpose();
  return d;
}

std::vector<ContactResult<double>> RotatingDisc::contacts(double t, const Eigen::VectorXd& y)
{
  move_points(t, y);
  return by_pad(contact_.pads(), contact_.contacts());
}

}  // namespace chladni::squeal
