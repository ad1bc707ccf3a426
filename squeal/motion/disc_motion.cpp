#include "squeal/motion/disc_motion.hpp"

#include <cmath>
#include <utility>

#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"

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

namespace {

SquealOptions without_pads(SquealOptions options)
{
  options.pads.clear();
  return options;
}

/// What the normal force alone does of a state: N / s along the axis, sigma N g / s in the plane.
PadState<double> without_friction(PadState<double> state, const RingMotion<double>& m, double sigma)
{
  const double s = std::sqrt(1.0 + m.g_r * m.g_r + m.g_t * m.g_t);
  state.S = state.N / s;
  state.f_r = sigma * state.N * m.g_r / s;
  state.f_t = sigma * state.N * m.g_t / s;
  return state;
}

/// What the friction of one pad turns into heat, W.
double heat(const PadContact& pad, const PadState<double>& state)
{
  const double v = regularised_speed(pad.friction, state.slip_speed * state.slip_speed);
  const double N = pad.law == ContactLaw::signed_force ? state.N : std::abs(state.N);
  return friction_coefficient(pad.friction, v, pressure_of(pad, state.S)) * N * state.slip_speed *
         state.slip_speed / v;
}

/// Powers of a point pair on disc and plates, W; see SlidingDisc::Power.
struct PointPower {
  double friction, normal, heat;
};

/// Friction is what the normal forces are not; so is the friction at rest that plates are held
/// against.
/// @param at        the motion, with what modes without inertia do
/// @param velocity  of the modes with inertia alone, which hold the energy
/// @param all       the contact at this motion
PointPower point_power(const BrakePoint& point, const PointMotion& at,
                       const PairVector<double>& velocity, const ContactResult<double>& all)
{
  const PadContact& pad = point.contact;
  const auto rows = static_cast<int>(at.g.size());
  const PairMotion<double> m = pair_motion(at.g, at.g_dot);
  const ContactResult<double> pressed{without_friction(all.upper, m.upper, 1.0),
                                      without_friction(all.lower, m.lower, -1.0)};
  RestStates at_rest = point.at_rest;
  for (PadState<double>& state : at_rest) state.f_t = 0.0;
  const double total = velocity.dot(pair_forces(pad, m, all, point.at_rest, rows));
  const double normal = velocity.dot(pair_forces(pad, m, pressed, at_rest, rows));
  return {total - normal, normal, heat(pad, all.upper) + heat(pad, all.lower)};
}

}  // namespace

SlidingDisc::SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      contact_(disc.compliance, pad_system(options, ring_places(disc)), options.contact, speed),
      omega_(with_pads(disc, contact_.pads()).omega),
      A_(state_matrix(with_pads(disc, contact_.pads()), without_pads(options), speed))
{
  for (const PointPair& point : contact_.pads().points)
    contact_.points().push_back(brake_point(shapes_at(disc, point), contact_.pads(), point, speed));
}

void SlidingDisc::move_points(const Eigen::VectorXd& x)
{
  const Eigen::Index n = omega_.size();
  for (std::size_t i = 0; i < contact_.points().size(); ++i) {
    const PairShapes& S = contact_.points()[i].S;
    contact_.motions()[i] = {.g = S.transpose() * x.head(n).cwiseQuotient(omega_),
                             .g_dot = S.transpose() * x.tail(n)};
  }
}

const Eigen::VectorXd& SlidingDisc::rate(double /*t*/, const Eigen::VectorXd& x)
{
  ++n_evaluations_;
  f_.noalias() = A_ * x;
  move_points(x);
  contact_.add_forces(f_.tail(omega_.size()));
  return f_;
}

Eigen::MatrixXd SlidingDisc::jacobian(const Eigen::VectorXd& x)
{
  n_evaluations_ += 6;
  const Eigen::Index n = omega_.size();
  Eigen::MatrixXd J = A_;
  move_points(x);
  const StackedContact contact = contact_.derivatives(n);
  J.bottomLeftCorner(n, n).noalias() +=
      contact.S * contact.D_a * contact.S.transpose() * omega_.cwiseInverse().asDiagonal();
  J.bottomRightCorner(n, n).noalias() += contact.S * contact.D_p * contact.S.transpose();
  return J;
}

ContactResult<double> SlidingDisc::first_contact(const Eigen::VectorXd& x)
{
  return sample(x).first;
}

SlidingDisc::Sample SlidingDisc::sample(const Eigen::VectorXd& x)
{
  ++n_evaluations_;
  const auto n_pads = static_cast<Eigen::Index>(contact_.pads().n_pads());
  const Eigen::Index n = omega_.size();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n_pads);
  const auto p = x.tail(n);
  Power power{zero, zero, zero, p.dot(A_.bottomRightCorner(n, n) * p)};
  move_points(x);
  std::vector<PairVector<double>> velocities;
  for (const PointMotion& at : contact_.motions()) velocities.push_back(at.g_dot);
  const std::vector<ContactResult<double>> contacts = contact_.contacts();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const PointPower of_point =
        point_power(contact_.points()[i], contact_.motions()[i], velocities[i], contacts[i]);
    const auto pad = static_cast<Eigen::Index>(contact_.pads().points[i].pad);
    power.friction[pad] += of_point.friction;
    power.normal[pad] += of_point.normal;
    power.heat[pad] += of_point.heat;
  }
  return {by_pad(contact_.pads(), contacts).front(), power};
}

}  // namespace chladni::squeal
