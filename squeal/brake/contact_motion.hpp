#pragma once

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

}  // namespace chladni::squeal
