#include "squeal/motion/sliding_disc.hpp"

#include <cmath>
#include <span>

#include "squeal/brake/contact_branch.hpp"
#include "squeal/brake/state_matrix.hpp"

namespace chladni::squeal {
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
  return friction_coefficient(pad.friction, v) * N * state.slip_speed * state.slip_speed / v;
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
  const RingMotion<double> m = pair_motion(at.g, at.g_dot);
  const PadState<double> up = without_friction(all.upper, m, 1.0);
  const PadState<double> lo = without_friction(all.lower, m, -1.0);
  PadState<double> at_rest = point.at_rest;
  at_rest.f_t = 0.0;
  const double total =
      velocity.dot(pair_forces(all.force, all.upper, all.lower, point.at_rest, rows));
  const double normal =
      velocity.dot(pair_forces(pair_force(pad, m, up, lo), up, lo, at_rest, rows));
  return {total - normal, normal, heat(pad, all.upper) + heat(pad, all.lower)};
}

}  // namespace

SlidingDisc::SlidingDisc(const InertialDisc& disc, const SquealOptions& options, double speed)
    : speed_(speed),
      pulled_(pulled_branch(options.contact)),
      pads_(pad_system(options, ring_places(disc))),
      omega_(with_pads(disc, pads_).omega),
      A_(state_matrix(with_pads(disc, pads_), without_pads(options), speed)),
      series_(disc.compliance, pads_, speed),
      motions_(pads_.points.size()),
      branches_(2 * pads_.points.size(), 1.0),
      S_(options.contact == ContactLaw::signed_force
             ? Eigen::VectorXd()
             : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(branches_.size())))
{
  for (const PointPair& point : pads_.points)
    points_.push_back(brake_point(matrix_of(shapes_at(disc, disc.rings[point.ring], point.angle)),
                                  pads_, point, speed));
}

PointMotion SlidingDisc::motion_at(const BrakePoint& point, const Eigen::VectorXd& x) const
{
  const Eigen::Index n = omega_.size();
  return {.g = point.S.transpose() * x.head(n).cwiseQuotient(omega_),
          .g_dot = point.S.transpose() * x.tail(n)};
}

const std::vector<PointMotion>& SlidingDisc::motions(const Eigen::VectorXd& x)
{
  for (std::size_t i = 0; i < points_.size(); ++i) motions_[i] = motion_at(points_[i], x);
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) -> Eigen::Vector3d {
    return force_on_branch<double>(points_[i], pair_motion(at.g, at.g_dot), speed_,
                                   std::span(branches_).subspan(2 * i, 2))
        .head<3>();
  });
  return motions_;
}

const Eigen::VectorXd& SlidingDisc::rate(double /*t*/, const Eigen::VectorXd& x)
{
  ++n_evaluations_;
  f_.noalias() = A_ * x;
  motions(x);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const BrakePoint& point = points_[i];
    const PointMotion& at = motions_[i];
    const RingMotion<double> motion = pair_motion(at.g, at.g_dot);
    const auto up = pad_on_branch(point.contact, motion, speed_, {1.0, branches_[2 * i]});
    const auto lo = pad_on_branch(point.contact, motion, speed_, {-1.0, branches_[2 * i + 1]});
    if (S_.size() > 0) {
      const auto first = static_cast<Eigen::Index>(2 * i);
      S_[first] = pressure(point.contact, up, motion.upper, 1.0);
      S_[first + 1] = pressure(point.contact, lo, motion.lower, -1.0);
    }
    f_.tail(omega_.size()).noalias() +=
        point.S * pair_forces(pair_force(point.contact, motion, up, lo), up, lo, point.at_rest,
                              static_cast<int>(point.S.cols()));
  }
  return f_;
}

double SlidingDisc::side(Eigen::Index i) const
{
  return branches_[static_cast<std::size_t>(i)] == 1.0 ? 1.0 : -1.0;
}

void SlidingDisc::set_side(Eigen::Index i, double side)
{
  branches_[static_cast<std::size_t>(i)] = side > 0.0 ? 1.0 : pulled_;
}

Eigen::MatrixXd SlidingDisc::jacobian(const Eigen::VectorXd& x)
{
  n_evaluations_ += 6;
  const Eigen::Index n = omega_.size();
  Eigen::MatrixXd J = A_;
  motions(x);
  StackedContact contact = stacked_contact(pads_, n);
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
  const auto n_pads = static_cast<Eigen::Index>(pads_.n_pads());
  const Eigen::Index n = omega_.size();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n_pads);
  const auto p = x.tail(n);
  Power power{zero, zero, zero, p.dot(A_.bottomRightCorner(n, n) * p)};
  std::vector<ContactResult<double>> contacts;
  std::vector<PairVector<double>> velocities;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    motions_[i] = motion_at(points_[i], x);
    velocities.push_back(motions_[i].g_dot);
  }
  series_.add_to(motions_, [&](std::size_t i, const PointMotion& at) -> Eigen::Vector3d {
    const auto force = contact(points_[i].contact, pair_motion(at.g, at.g_dot), speed_).force;
    return {force.F_w, force.F_r, force.F_t};
  });
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PointMotion& at = motions_[i];
    contacts.push_back(contact(points_[i].contact, pair_motion(at.g, at.g_dot), speed_));
    const PointPower of_point = point_power(points_[i], at, velocities[i], contacts.back());
    const auto pad = static_cast<Eigen::Index>(pads_.points[i].pad);
    power.friction[pad] += of_point.friction;
    power.normal[pad] += of_point.normal;
    power.heat[pad] += of_point.heat;
  }
  return {by_pad(pads_, contacts).front(), power};
}

}  // namespace chladni::squeal
