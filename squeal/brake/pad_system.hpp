#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Two opposite contact points, above and below the disc.
struct PointPair {
  std::size_t pad;   ///< which of the scene's pads
  double angle;      ///< rad
  std::size_t ring;  ///< which of the disc's rings
  PadContact contact;
  Eigen::MatrixX3d
      upper;  ///< [n_pad_modes x 3] motion of the plate there, (r, t, z) per coordinate
  Eigen::MatrixX3d lower;
};

/// All pads of a scene: contact points, and the modes of the plates and calipers on their
/// suspensions, b'' + C b' + diag(omega^2) b = forces, b counted from the sliding equilibrium with
/// the pressure shared equally among the points of a pad, which is how pads wear.
struct PadSystem {
  std::vector<PointPair> points;
  Eigen::VectorXd omega;  ///< [n_pad_modes] rad/s; empty when all pads are massless
  Eigen::MatrixXd C;      ///< [n_pad_modes x n_pad_modes] 1/s

  Eigen::Index n_modes() const { return omega.size(); }
  std::size_t n_pads() const { return points.empty() ? 0 : points.back().pad + 1; }
};

/// @param rings  of the disc; the first is that of pads without a grid
/// @throws chladni::Error for a body without a suspension, a caliper without a body to carry, and a
///         grid on a ring that the disc does not have.
PadSystem pad_system(const SquealOptions& options, const std::vector<RingPlace>& rings);

/// The same on one ring of this radius, m.
PadSystem pad_system(const SquealOptions& options, double radius);

/// The disc with the pads' modes as further coordinates at its end, which do not move the ring.
InertialDisc with_pads(InertialDisc disc, const PadSystem& pads);

/// The motion of a point pair, one row of `PairShapes` each:
/// (w, g_r, g_t) of the disc, then (r, t, z) of the upper and of the lower plate if pads move.
inline constexpr int pair_rows_max = 9;
template <class Scalar>
using PairVector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, pair_rows_max, 1>;

/// [n x 3] or [n x 9]: what each coordinate of disc and pads does at a point pair.
using PairShapes =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, pair_rows_max>;

/// @param S  [n_disc_modes x 3] of the disc at the point: W, W_r, W_t
PairShapes pair_shapes(const Eigen::MatrixX3d& S, const PadSystem& pads, const PointPair& point);

/// All that the force at a point pair depends on but the motion.
struct BrakePoint {
  PadContact contact;
  PairShapes S;
  PadState<double> at_rest;  ///< of its upper pad, on the undisturbed disc
};

/// @param S  as in `pair_shapes`
BrakePoint brake_point(const Eigen::MatrixX3d& S, const PadSystem& pads, const PointPair& point,
                       double speed);

/// The modes of a disc, then those of the pads, without contact:
/// q'' + C q' + diag(omega^2) q = 0 in the frame that rotates with the disc.
struct FreeBrake {
  Eigen::VectorXd omega;  ///< rad/s
  Eigen::MatrixXd C;      ///< 1/s, with the Coriolis terms of the disc at this speed
};
FreeBrake free_brake(const Disc& disc, const PadSystem& pads, double speed);

template <class Scalar>
RingMotion<Scalar> pair_motion(const PairVector<Scalar>& g, const PairVector<Scalar>& g_dot)
{
  RingMotion<Scalar> m{g[0], g[1], g[2], g_dot[0], g_dot[1], g_dot[2]};
  if (g.size() == pair_rows_max) {
    m.upper = {g[5], g_dot[3], g_dot[4], g_dot[5]};
    m.lower = {g[8], g_dot[6], g_dot[7], g_dot[8]};
  }
  return m;
}

/// The force on disc and plates, in the order of `PairShapes`, of which a point pair with the
/// friction of an undisturbed disc is free: `at_rest` is counted out of the forces on the plates.
template <class Scalar>
PairVector<Scalar> pair_forces(const RingForce<Scalar>& on_disc, const PadState<Scalar>& up,
                               const PadState<Scalar>& lo, const PadState<double>& at_rest,
                               int rows)
{
  PairVector<Scalar> F(rows);
  F.template head<3>() << on_disc.F_w, on_disc.F_r, on_disc.F_t;
  if (rows == pair_rows_max)
    F.template tail<6>() << -up.f_r, at_rest.f_t - up.f_t, up.S - at_rest.S, -lo.f_r,
        at_rest.f_t - lo.f_t, at_rest.S - lo.S;
  return F;
}

/// Derivatives of `pair_forces` about rest, by complex steps: D_a by the motion, D_p by its rates.
struct PairDerivatives {
  Eigen::MatrixXd D_a;  ///< [rows x rows]
  Eigen::MatrixXd D_p;  ///< [rows x rows]
};
PairDerivatives pair_derivatives(const PadContact& pad, double speed, int rows);

/// What one sees of each pad pair: forces summed over its points, motions averaged.
std::vector<ContactResult<double>> by_pad(const PadSystem& pads,
                                          const std::vector<ContactResult<double>>& points);

}  // namespace chladni::squeal
