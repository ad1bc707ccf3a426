#pragma once

#include <array>
#include <cmath>
#include <complex>

#include "squeal/brake_options.hpp"
#include "squeal/friction.hpp"

namespace chladni::squeal {

/// Motion of a pad's plate at a contact point; zero for a massless pad.
template <class Scalar>
struct PlateMotion {
  Scalar z = Scalar(0.0);      ///< axial displacement, m
  Scalar r_dot = Scalar(0.0);  ///< radial velocity, m/s
  Scalar t_dot = Scalar(0.0);  ///< circumferential velocity, m/s
  Scalar z_dot = Scalar(0.0);  ///< axial velocity, m/s
};

/// Motion of the disc under a pad (displacement, slopes and their material rates), and of both
/// plates.
template <class Scalar>
struct RingMotion {
  Scalar w;        ///< axial displacement, m
  Scalar g_r;      ///< radial slope, rad
  Scalar g_t;      ///< circumferential slope, rad
  Scalar w_dot;    ///< material rate of w, m/s
  Scalar g_r_dot;  ///< material rate of g_r, rad/s
  Scalar g_t_dot;  ///< material rate of g_t, rad/s
  PlateMotion<Scalar> upper = {};
  PlateMotion<Scalar> lower = {};
};

/// Motion of the disc under both pads of a pair: the same point of a middle surface twice, or the
/// points of two rings, each with the plate on its side.
template <class Scalar>
struct PairMotion {
  RingMotion<Scalar> upper;
  RingMotion<Scalar> lower;
};

/// Generalised contact force on a ring: Q_i = F_w W_i + F_r W_r,i + F_t W_t,i.
template <class Scalar>
struct RingForce {
  Scalar F_w;  ///< N
  Scalar F_r;  ///< N m
  Scalar F_t;  ///< N m
};

/// State of one pad of a pair. The disc under it is a plate whose normals keep their length:
/// z - sigma h / 2 = w + sigma h (s - 1) / 2, the deflection w of the middle surface plus a term
/// from the tilt of the normals. The face of a solid disc moves less where the plate is bent,
/// because its thickness changes, by nu / (1 - nu) h^2 / 8 times the Laplacian of w.
template <class Scalar>
struct PadState {
  Scalar z;           ///< height of the contact point on the pad axis, m
  Scalar z_dot;       ///< velocity of the pad, m/s
  Scalar N;           ///< normal force, N
  Scalar slip_speed;  ///< |v_r|, m/s
  Scalar S;           ///< force of the pad along its axis, N
  Scalar f_r;         ///< in-plane force on the disc, radial, N
  Scalar f_t;         ///< in-plane force on the disc, circumferential, N
};

/// States of both pads of a pair.
template <class Scalar>
struct ContactResult {
  PadState<Scalar> upper;
  PadState<Scalar> lower;
};

inline double real_part(double x)
{
  return x;
}
inline double real_part(const std::complex<double>& x)
{
  return x.real();
}

/// Contact place of one pad of a pair on the undeformed disc.
struct PadFace {
  double radius;    ///< radius of the ring under the pad, m
  double plane;     ///< height of the contact plane above the middle of both contact planes, m
  double distance;  ///< height of the contact plane above the ring, m; negative below the ring
};

/// One pad pair on a disc: all data of the contact forces except the motion.
struct PadContact {
  std::array<PadFace, 2> faces;  ///< place of the upper pad, of the lower pad
  FrictionLaw friction;
  ContactLaw law;
  PadSpring spring;   ///< spring of each pad
  double damping;     ///< damping d of each pad, N s/m
  double preload;     ///< preload N_0 of each pad, N
  double area = 0.0;  ///< area of each pad's face, m^2; 0: the pressure is unknown
};

/// Pad pressure |S| / area, Pa; 0 when the area is unknown.
template <class Scalar>
Scalar pressure_of(const PadContact& pad, const Scalar& S)
{
  if (!(pad.area > 0.0)) return Scalar(0.0);
  return real_part(S) < 0.0 ? Scalar(-S / pad.area) : Scalar(S / pad.area);
}

/// The contact place of the pad above (sigma = 1) or below (sigma = -1) the disc.
inline const PadFace& face_of(const PadContact& pad, double sigma)
{
  return pad.faces[sigma > 0.0 ? 0 : 1];
}

/// Axial pad force after the contact law, and the sign g of the normal force N in the friction
/// force.
template <class Scalar>
struct AxialForce {
  Scalar S;
  double g;
};

/// Applies the contact law to the axial force `S` (N) of a pad that would stay in contact.
template <class Scalar>
AxialForce<Scalar> axial_force(ContactLaw law, const Scalar& S)
{
  const bool pulls = real_part(S) < 0.0;
  if (law == ContactLaw::unilateral && pulls) return {Scalar(0.0), 1.0};
  return {S, law == ContactLaw::bilateral && pulls ? -1.0 : 1.0};
}

/// State of the pad above (sigma = +1) or below (sigma = -1) the disc. The contact plane is a
/// tangent plane rigidly offset from the ring by the distance e, e = sigma h / 2 from a middle
/// surface. The pad is massless and guided laterally, so that its axial equilibrium gives the
/// normal force:
///   x = w + e (s - 1),   n = (-g_r, -g_t, 1) / s,   s = sqrt(1 + g_r^2 + g_t^2)
///   S = N_0 + sigma (k x + k_3 x^3 + d x'),   z = x + the height of the contact plane
///   N = S / (1 / s + sigma g mu t_z),   t = v_r / |v_r|
///   f = sigma N (g_r, g_t) / s - mu g N (t_x, t_y)
/// with mu(v) or mu(v, |S| / area) and the regularised |v_r| of FrictionLaw. When the pad's plate
/// moves, x and v_r are relative to the plate; the motion of the contact point over the disc, of
/// second order, is neglected.
/// @param speed  rotation speed of the disc, rad/s
template <class Scalar>
PadState<Scalar> pad_state(const PadContact& pad, const RingMotion<Scalar>& m, double speed,
                           double sigma)
{
  using std::sqrt;
  const Scalar s = sqrt(1.0 + m.g_r * m.g_r + m.g_t * m.g_t);
  const PadFace& face = face_of(pad, sigma);
  const Scalar lever = face.distance / s;
  const PlateMotion<Scalar>& plate = sigma > 0.0 ? m.upper : m.lower;
  const Scalar v_x = -lever * m.g_r_dot - plate.r_dot;
  const Scalar v_y = speed * face.radius - lever * m.g_t_dot - plate.t_dot;
  const Scalar v_z = m.g_r * v_x + m.g_t * v_y;
  const Scalar slip_squared = v_x * v_x + v_y * v_y + v_z * v_z;
  const Scalar v = regularised_speed(pad.friction, slip_squared);

  const Scalar lift = m.w + face.distance * (s - 1.0);
  const Scalar z_dot = m.w_dot - v_z;
  const auto [S, g] = axial_force<Scalar>(
      pad.law, pad.preload + sigma * (force(pad.spring, Scalar(lift - plate.z)) +
                                      pad.damping * (z_dot - plate.z_dot)));
  const Scalar g_mu_by_v = g * friction_coefficient(pad.friction, v, pressure_of(pad, S)) / v;
  const Scalar N = S / (1.0 / s + sigma * g_mu_by_v * v_z);
  return {lift + face.plane,
          z_dot,
          N,
          sqrt(slip_squared),
          S,
          sigma * N * m.g_r / s - g_mu_by_v * N * v_x,
          sigma * N * m.g_t / s - g_mu_by_v * N * v_y};
}

/// Moment arm e / s of in-plane forces at the contact plane about the ring, m.
template <class Scalar>
Scalar lever_arm(const PadFace& face, const RingMotion<Scalar>& m)
{
  using std::sqrt;
  return face.distance / sqrt(1.0 + m.g_r * m.g_r + m.g_t * m.g_t);
}

/// Generalised force of both pads of a pair on a middle surface,
///   Q_i = (S_- - S_+) W_i + h / (2 s) ((f_r- - f_r+) W_r,i + (f_t- - f_t+) W_t,i)
template <class Scalar>
RingForce<Scalar> pair_force(const PadContact& pad, const RingMotion<Scalar>& m,
                             const PadState<Scalar>& up, const PadState<Scalar>& lo)
{
  const Scalar lever = lever_arm(pad.faces[0], m);
  return {lo.S - up.S, lever * (lo.f_r - up.f_r), lever * (lo.f_t - up.f_t)};
}

/// States of both pads of a pair, valid in the rotating frame with (q, q') and in the inertial
/// frame with (a, p).
/// @param speed  rotation speed, rad/s; not zero for a disc at rest unless friction is regularised
template <class Scalar>
ContactResult<Scalar> contact(const PadContact& pad, const PairMotion<Scalar>& m, double speed)
{
  return {pad_state(pad, m.upper, speed, 1.0), pad_state(pad, m.lower, speed, -1.0)};
}

/// Checks that the friction table covers the sliding equilibrium, because values and slopes outside
/// the table are not measured.
/// @param speed  rotation speed, rad/s
/// @throws chladni::Error naming the key, the value and the range of the table.
void require_in_table(const PadContact& pad, double speed);

}  // namespace chladni::squeal
