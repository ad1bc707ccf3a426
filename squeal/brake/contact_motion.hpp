#pragma once

namespace chladni::squeal {

/// Motion of the plate of a pad at a contact point, for a pad with a mass; zero for any other one.
template <class Scalar>
struct PlateMotion {
  Scalar z = Scalar(0.0);      ///< along the axis, m
  Scalar r_dot = Scalar(0.0);  ///< radial, m/s
  Scalar t_dot = Scalar(0.0);  ///< circumferential, m/s
  Scalar z_dot = Scalar(0.0);  ///< along the axis, m/s
};

/// Motion of the disc under a pad: displacement, slopes and their material rates; and that of the
/// two plates.
template <class Scalar>
struct RingMotion {
  Scalar w;        ///< m
  Scalar g_r;      ///< radial slope, rad
  Scalar g_t;      ///< circumferential slope, rad
  Scalar w_dot;    ///< m/s
  Scalar g_r_dot;  ///< rad/s
  Scalar g_t_dot;  ///< rad/s
  PlateMotion<Scalar> upper = {};
  PlateMotion<Scalar> lower = {};
};

/// Motion of the disc under the two pads of a pair: one and the same point of a middle surface, or
/// the points of two rings, each with the plate above or below it.
template <class Scalar>
struct PairMotion {
  RingMotion<Scalar> upper;
  RingMotion<Scalar> lower;
};

/// Generalised contact force: Q_i = F_w W_i + F_r W_r,i + F_t W_t,i.
template <class Scalar>
struct RingForce {
  Scalar F_w;  ///< N
  Scalar F_r;  ///< N m
  Scalar F_t;  ///< N m
};

/// State of one of the two pads of a pair. The disc under it is a plate whose normals keep their
/// length: z - sigma h / 2 = w + sigma h (s - 1) / 2 is the deflection w of its middle surface but
/// for the lean of the normals. The face of a solid disc moves less where the plate is bent, since
/// its thickness changes, by nu / (1 - nu) h^2 / 8 times the Laplacian of w.
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

/// The states of the two pads of a pair.
template <class Scalar>
struct ContactResult {
  PadState<Scalar> upper;
  PadState<Scalar> lower;
};

}  // namespace chladni::squeal
