#include "squeal/motion/rotating_disc.hpp"

#include <span>
#include <utility>

#include "squeal/brake/contact_branch.hpp"

namespace chladni::squeal {

RotatingDisc::RotatingDisc(const Disc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      pulled_(pulled_branch(options.contact)),
      rings_(disc.rings.begin(), disc.rings.end()),
      pads_(pad_system(options, ring_places(disc))),
      series_(disc.compliance, pads_, speed),
      motions_(pads_.points.size()),
      branches_(2 * pads_.points.size(), 1.0),
      S_(options.contact == ContactLaw::signed_force
             ? Eigen::VectorXd()
             : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(branches_.size())))
{
  FreeBrake brake = free_brake(disc, pads_, speed);
  omega_ = std::move(brake.omega);
  C_ = std::move(brake.C);
  damped_ = !C_.isZero(0.0);
  f_.resize(2 * omega_.size());
  q_.resize(omega_.size());
  for (const PointPair& point : pads_.points)
    points_.push_back(brake_point(rings_[point.ring].at(point.angle), pads_, point, speed));
}

const PairShapes& RotatingDisc::shapes(std::size_t i, double t)
{
  const PointPair& point = pads_.points[i];
  const Eigen::MatrixX3d& S = rings_[point.ring].at(point.angle - speed_ * t);
  points_[i].S.topLeftCorner(S.rows(), 3) = S;
  return points_[i].S;
}

PointMotion RotatingDisc::point_motion(const PairShapes& S, const Eigen::VectorXd& y)
{
  const Eigen::Index n = omega_.size();
  q_ = y.head(n).cwiseQuotient(omega_);
  return {.g = S.transpose() * q_, .g_dot = S.transpose() * y.tail(n)};
}

const std::vector<PointMotion>& RotatingDisc::motions(double t, const Eigen::VectorXd& y)
{
  for (std::size_t i = 0; i < points_.size(); ++i) motions_[i] = point_motion(shapes(i, t), y);
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) -> Eigen::Vector3d {
    return force_on_branch<double>(points_[i], pair_motion(at.g, at.g_dot), speed_,
                                   std::span(branches_).subspan(2 * i, 2))
        .head<3>();
  });
  return motions_;
}

/// f = (diag(omega) v, -diag(omega) (omega q) - C v + sum_points S F)
const Eigen::VectorXd& RotatingDisc::rate(double t, const Eigen::VectorXd& y)
{
  const Eigen::Index n = omega_.size();
  ++n_evaluations_;
  f_.head(n) = omega_.cwiseProduct(y.tail(n));
  f_.tail(n) = -omega_.cwiseProduct(y.head(n));
  if (damped_) f_.tail(n).noalias() -= C_ * y.tail(n);
  motions(t, y);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PairShapes& S = points_[i].S;
    const PointMotion& at = motions_[i];
    const RingMotion<double> motion = pair_motion(at.g, at.g_dot);
    const PadContact& pad = points_[i].contact;
    const auto up = pad_on_branch(pad, motion, speed_, {1.0, branches_[2 * i]});
    const auto lo = pad_on_branch(pad, motion, speed_, {-1.0, branches_[2 * i + 1]});
    if (S_.size() > 0) {
      const auto first = static_cast<Eigen::Index>(2 * i);
      S_[first] = pressure(pad, up, motion.upper, 1.0);
      S_[first + 1] = pressure(pad, lo, motion.lower, -1.0);
    }
    f_.tail(n).noalias() += S * pair_forces(pair_force(pad, motion, up, lo), up, lo,
                                            points_[i].at_rest, static_cast<int>(S.cols()));
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

int RotatingDisc::pad_of(Eigen::Index i) const
{
  const std::size_t pair = pads_.points[static_cast<std::size_t>(i / 2)].pad;
  return 2 * static_cast<int>(pair) + static_cast<int>(i % 2);
}

Motion::Tangent RotatingDisc::tangent(double t, const Eigen::VectorXd& y)
{
  const Eigen::VectorXd squares = omega_.cwiseAbs2();
  n_evaluations_ += 6;
  Tangent d{-squares.asDiagonal().toDenseMatrix(), -C_};
  motions(t, y);
  StackedContact contact = stacked_contact(pads_, omega_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PairShapes& S = points_[i].S;
    const Eigen::MatrixXd D = force_derivative(points_[i], motions_[i].g, motions_[i].g_dot,
                                               {speed_, std::span(branches_).subspan(2 * i, 2)});
    const Eigen::Index at = S.cols() * static_cast<Eigen::Index>(i);
    contact.S.middleCols(at, S.cols()) = S;
    contact.D_a.block(at, at, S.cols(), S.cols()) = D.leftCols(S.cols());
    contact.D_p.block(at, at, S.cols(), S.cols()) = D.rightCols(S.cols());
  }
  series_.condense(contact);
  d.by_q += contact.S * contact.D_a * contact.S.transpose();
  d.by_v += contact.S * contact.D_p * contact.S.transpose();
  return d;
}

std::vector<ContactResult<double>> RotatingDisc::contacts(double t, const Eigen::VectorXd& y)
{
  std::vector<ContactResult<double>> results;
  for (std::size_t i = 0; i < points_.size(); ++i) motions_[i] = point_motion(shapes(i, t), y);
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) -> Eigen::Vector3d {
    const auto force = contact(points_[i].contact, pair_motion(at.g, at.g_dot), speed_).force;
    return {force.F_w, force.F_r, force.F_t};
  });
  for (std::size_t i = 0; i < points_.size(); ++i)
    results.push_back(
        contact(points_[i].contact, pair_motion(motions_[i].g, motions_[i].g_dot), speed_));
  return by_pad(pads_, results);
}

}  // namespace chladni::squeal
