#include "brake_fmu/driven_disc.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "common/error.hpp"

namespace chladni::brake_fmu {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// The largest eigenvalue of a symmetric matrix, from below, by its powers.
double largest_eigenvalue(const MatrixXd& A)
{
  constexpr int n_powers = 50;
  VectorXd x = VectorXd::LinSpaced(A.rows(), 1.0, 2.0).normalized();
  double value = 0.0;
  for (int i = 0; i < n_powers; ++i) {
    const VectorXd y = A * x;
    value = y.norm();
    if (value == 0.0) return 0.0;
    x = y / value;
  }
  return value;
}

void check(const Drive& drive, const squeal::PadSystem& pads)
{
  const bool is_regularised = pads.points.front().contact.friction.regularisation > 0.0;
  if (!(drive.speed > 0.0) && !is_regularised) {
    throw Error("the speed is " + std::to_string(drive.speed) +
                " rad/s; it must be above 0, for friction has no direction at rest unless the "
                "scene regularises it");
  }
  if (!(drive.friction >= 0.0))
    throw Error("the friction is " + std::to_string(drive.friction) + "; it must be at least 0");
  for (std::size_t i = 0; i < drive.preloads.size(); ++i) {
    if (drive.preloads[i] > 0.0) continue;
    throw Error("the preload of pad " + std::to_string(i + 1) + " is " +
                std::to_string(drive.preloads[i]) + " N; it must be above 0");
  }
}

}  // namespace

std::vector<double> preloads_of(const squeal::PadSystem& pads)
{
  std::vector<double> preloads(pads.n_pads(), 0.0);
  for (const squeal::PointPair& point : pads.points) preloads[point.pad] += point.contact.preload;
  return preloads;
}

DrivenDisc::DrivenDisc(const BrakeModel& model)
    : model_(model),
      pads_(model.pads),
      shapes_(model.disc),
      series_(model.disc.compliance, pads_, 1.0),
      drive_{.speed = 0.0, .friction = 0.0, .preloads = {}},
      motions_(pads_.points.size()),
      contacts_(pads_.points.size())
{}

void DrivenDisc::set_drive(const Drive& drive)
{
  if (drive == drive_) return;
  check(drive, model_.pads);
  drive_ = drive;
  rebuild();
}

void DrivenDisc::rebuild()
{
  const std::vector<double> usual = preloads_of(model_.pads);
  for (std::size_t i = 0; i < pads_.points.size(); ++i) {
    const squeal::PadContact& of_scene = model_.pads.points[i].contact;
    const std::size_t pad = pads_.points[i].pad;
    squeal::PadContact& contact = pads_.points[i].contact;
    contact.friction.kinetic = drive_.friction;
    contact.preload = of_scene.preload * (drive_.preloads[pad] / usual[pad]);
  }
  squeal::FreeBrake free = squeal::free_brake(model_.disc, pads_, drive_.speed);
  omega_ = std::move(free.omega);
  C_ = std::move(free.C);
  series_ = squeal::ContactSeries(model_.disc.compliance, pads_, drive_.speed);
  points_.clear();
  for (const squeal::PointPair& point : pads_.points)
    points_.push_back(squeal::brake_point(shapes_.at(point, 0.0), pads_, point, drive_.speed));
}

VectorXd DrivenDisc::acceleration(double angle, const VectorXd& q, const VectorXd& v)
{
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const MatrixXd& of_disc = shapes_.at(pads_.points[i], angle);
    squeal::PairShapes& S = points_[i].S;
    S.topLeftCorner(of_disc.rows(), of_disc.cols()) = of_disc;
    motions_[i] = {.g = S.transpose() * q, .g_dot = S.transpose() * v};
  }
  series_.add_to(motions_, [&](std::size_t i, const squeal::PointMotion& at) {
    return squeal::contact_at(points_[i], at, drive_.speed).force;
  });
  VectorXd a = -omega_.cwiseAbs2().cwiseProduct(q) - C_ * v;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const squeal::PairContact at = squeal::contact_at(points_[i], motions_[i], drive_.speed);
    contacts_[i] = at.states;
    a += points_[i].S * at.force;
  }
  return a;
}

std::vector<squeal::ContactResult<double>> DrivenDisc::contacts() const
{
  return squeal::by_pad(pads_, contacts_);
}

double DrivenDisc::torque() const
{
  double torque = 0.0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const squeal::PadContact& contact = pads_.points[i].contact;
    torque += contact.faces[0].radius * contacts_[i].upper.f_t +
              contact.faces[1].radius * contacts_[i].lower.f_t;
  }
  return torque;
}

DrivenDisc::Rates DrivenDisc::fastest()
{
  MatrixXd K = omega_.cwiseAbs2().asDiagonal(), D = 0.5 * (C_ + C_.transpose());
  for (const squeal::BrakePoint& point : points_) {
    const squeal::PairDerivatives by =
        squeal::pair_derivatives(point.contact, drive_.speed, pads_.rows());
    K -= point.S * (0.5 * (by.D_a + by.D_a.transpose())) * point.S.transpose();
    D -= point.S * (0.5 * (by.D_p + by.D_p.transpose())) * point.S.transpose();
  }
  return {std::sqrt(largest_eigenvalue(K)), largest_eigenvalue(D)};
}

}  // namespace chladni::brake_fmu
