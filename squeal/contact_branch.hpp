#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "squeal/contact.hpp"

namespace chladni::squeal {

/// The smooth branches of a contact law. For one pad the branch is the factor g of the friction: 1
/// in contact, -1 where a bilateral pad pulls, 0 where a unilateral pad is off.
/// @return g where the axial force of a pad is negative; 1 for the law that has one branch only
inline double pulled_branch(ContactLaw law)
{
  return law == ContactLaw::unilateral ? 0.0 : law == ContactLaw::bilateral ? -1.0 : 1.0;
}

/// One pad on a branch: the signed law with the friction g mu, or nothing.
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

/// (F_w, F_r, F_t) of a pair, each pad on its branch: upper, lower.
template <class Scalar>
Eigen::Vector3<Scalar> force_on_branch(const PadContact& pad, const RingMotion<Scalar>& m,
                                       double speed, std::span<const double> branches)
{
  const RingForce<Scalar> F = pair_force(pad, m, pad_on_branch(pad, m, speed, {1.0, branches[0]}),
                                         pad_on_branch(pad, m, speed, {-1.0, branches[1]}));
  return {F.F_w, F.F_r, F.F_t};
}

/// Derivatives of `force_on_branch` by (w, g_r, g_t, w', g_r', g_t'), exact to rounding.
Eigen::Matrix<double, 3, 6> force_derivative(const PadContact& pad, const RingMotion<double>& m,
                                             double speed, std::span<const double> branches);

}  // namespace chladni::squeal
