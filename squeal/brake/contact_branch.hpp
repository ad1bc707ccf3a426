#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <utility>

#include "squeal/brake/contact.hpp"
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

}  // namespace chladni::squeal
