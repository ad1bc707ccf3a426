#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/pair_rows.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Two opposite contact points, above and below the disc.
struct PointPair {
  std::size_t pad;  ///< which of the scene's pads
  double angle;     ///< rad
  std::array<std::size_t, 2>
      rings;  ///< which of the disc's are below the upper pad, above the lower
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
  Eigen::VectorXd omega;        ///< [n_pad_modes] rad/s; empty when all pads are massless
  Eigen::MatrixXd C;            ///< [n_pad_modes x n_pad_modes] 1/s
  int disc_rows = middle_rows;  ///< of a point pair, those of the disc; see pair_rows.hpp

  Eigen::Index n_modes() const { return omega.size(); }
  /// Of a point pair.
  int rows() const { return disc_rows + (n_modes() > 0 ? plate_rows : 0); }
  std::size_t n_pads() const { return points.empty() ? 0 : points.back().pad + 1; }
};

/// @param rings  of the disc; the first, or the first two, are those of pads without a grid
/// @throws chladni::Error for a body without a suspension, a caliper without a body to carry, a
///         grid on a ring that the disc does not have, and two rings of a pair at one height.
PadSystem pad_system(const SquealOptions& options, const std::vector<RingPlace>& rings);

/// The same on one ring of this radius, m.
PadSystem pad_system(const SquealOptions& options, double radius);

/// The disc with the pads' modes as further coordinates at its end, which do not move the ring.
InertialDisc with_pads(InertialDisc disc, const PadSystem& pads);

/// @param S  [n_disc_modes x pads.disc_rows] of the disc at the point
PairShapes pair_shapes(const Eigen::MatrixXd& S, const PadSystem& pads, const PointPair& point);

/// All that the force at a point pair depends on but the motion.
struct BrakePoint {
  PadContact contact;
  PairShapes S;
  RestStates at_rest;
};

/// @param S  as in `pair_shapes`
BrakePoint brake_point(const Eigen::MatrixXd& S, const PadSystem& pads, const PointPair& point,
                       double speed);

/// The states of both pads of a point pair and what they exert, in the order of its rows.
struct PairContact {
  ContactResult<double> states;
  PairVector<double> force;
};
PairContact contact_at(const BrakePoint& point, const PointMotion& motion, double speed);

/// The modes of a disc, then those of the pads, without contact:
/// q'' + C q' + diag(omega^2) q = 0 in the frame that rotates with the disc.
struct FreeBrake {
  Eigen::VectorXd omega;  ///< rad/s
  Eigen::MatrixXd C;      ///< 1/s, with the Coriolis terms of the disc at this speed
};
FreeBrake free_brake(const Disc& disc, const PadSystem& pads, double speed);

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
