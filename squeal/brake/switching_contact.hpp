#pragma once

#include <Eigen/Core>

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/linear_contact.hpp"
#include "squeal/brake/pad_system.hpp"

namespace chladni::squeal {

/// Branch of a pad with negative axial force. The smooth branches of a contact law are numbered by
/// the factor g of the friction: 1 in contact, -1 where a bilateral pad pulls, 0 where a unilateral
/// pad has lost contact.
/// @return g; 1 for the signed law, which has one branch only
inline double pulled_branch(ContactLaw law)
{
  return law == ContactLaw::unilateral ? 0.0 : law == ContactLaw::bilateral ? -1.0 : 1.0;
}

/// State of a pad on a branch: the signed law with the friction coefficient g mu, or no force for
/// g = 0.
/// @param sigma_and_g  side of the disc (1 above, -1 below) and branch
template <class Scalar>
PadState<Scalar> pad_on_branch(PadContact pad, const RingMotion<Scalar>& m, double speed,
                               const std::array<double, 2>& sigma_and_g)
{
  const auto [sigma, g] = sigma_and_g;
  pad.law = ContactLaw::signed_force;
  pad.friction = scaled(pad.friction, g);
  PadState<Scalar> state = pad_state(pad, m, speed, sigma);
  if (g == 0.0) state.S = state.f_r = state.f_t = Scalar(0.0);
  return state;
}

/// Axial force of a pad that stays in contact, relative to its preload; negative where a unilateral
/// pad has lost contact.
inline double pressure(const PadContact& pad, const PadState<double>& state,
                       const PlateMotion<double>& plate, double sigma)
{
  const double x = state.z - face_of(pad, sigma).plane - plate.z;
  return 1.0 +
         sigma * (force(pad.spring, x) + pad.damping * (state.z_dot - plate.z_dot)) / pad.preload;
}

/// States of both pads of a pair on their branches.
/// @param branches  g of the upper pad, of the lower pad
template <class Scalar>
ContactResult<Scalar> contact_on_branch(const PadContact& pad, const PairMotion<Scalar>& m,
                                        double speed, std::span<const double> branches)
{
  return {pad_on_branch(pad, m.upper, speed, {1.0, branches[0]}),
          pad_on_branch(pad, m.lower, speed, {-1.0, branches[1]})};
}

/// Contact forces at a point pair with both pads on their branches.
/// @param branches  g of the upper pad, of the lower pad
template <class Scalar>
PairVector<Scalar> force_on_branch(const BrakePoint& point, const PairMotion<Scalar>& m,
                                   double speed, std::span<const double> branches)
{
  return pair_forces(point.contact, m, contact_on_branch(point.contact, m, speed, branches),
                     point.at_rest, static_cast<int>(point.S.cols()));
}

/// Derivatives of `force_on_branch` by the motion of the point and by its rates, exact to rounding.
/// @param at  rotation speed (rad/s) and branches
/// @return [rows x 2 rows]
Eigen::MatrixXd force_derivative(const BrakePoint& point, const PairVector<double>& g,
                                 const PairVector<double>& g_dot,
                                 const std::pair<double, std::span<const double>>& at);

/// All contact points of a disc's pads, each pad on a smooth branch of its contact law
/// (contact_branch.hpp), with the compliance of modes without inertia. The owner knows the motion
/// and its frame: it sets `points()[i].S` and `motions()[i]`, then calls add_forces or derivatives.
class SwitchingContact {
 public:
  SwitchingContact(const RingCompliance& compliance, PadSystem pads, ContactLaw law, double speed);

  const PadSystem& pads() const { return pads_; }
  std::vector<BrakePoint>& points() { return points_; }
  /// Motions of the contact points; the owner sets the part of the modes with inertia, and the
  /// functions below add the others.
  std::vector<PointMotion>& motions() { return motions_; }

  /// Adds the contact forces on the present branches to the rates of the modes, and updates the
  /// switching functions.
  void add_forces(Eigen::Ref<Eigen::VectorXd> p_dot);

  /// Derivatives of these forces.
  /// @param n  number of coordinates
  StackedContact derivatives(Eigen::Index n);

  /// Contact states by the full contact law, one for each point.
  std::vector<ContactResult<double>> contacts();

  /// Axial force of each pad relative to its preload, upper and lower pad of each point in turn;
  /// empty when the law has one branch.
  const Eigen::VectorXd& switches() const { return S_; }
  double side(Eigen::Index i) const;  ///< side of switching function i: 1 or -1
  void set_side(Eigen::Index i, double side);

 private:
  void follow_on_branches();

  double speed_;
  double pulled_;  ///< branch of a pad whose axial force is negative
  PadSystem pads_;
  std::vector<BrakePoint> points_;
  ContactSeries series_;
  std::vector<PointMotion> motions_;
  std::vector<double> branches_;  ///< branch of the upper and the lower pad of each point
  Eigen::VectorXd S_;
};

}  // namespace chladni::squeal
