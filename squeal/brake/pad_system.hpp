#pragma once

#include <Eigen/Core>

#include <array>
#include <complex>
#include <map>
#include <optional>
#include <vector>

#include "squeal/brake/contact.hpp"
#include "squeal/brake/disc.hpp"
#include "squeal/brake/disc_ring.hpp"
#include "squeal/brake/inertial_frame.hpp"
#include "squeal/brake/point_pair.hpp"
#include "squeal/brake_options.hpp"

namespace chladni::squeal {

/// Two opposite contact points, above and below the disc.
struct PointPair {
  std::size_t pad;  ///< index of its pad in the scene
  double angle;     ///< angle in the inertial frame, rad
  /// Radius of the patch that the point stands for over that of its ring; 0: a point.
  double patch = 0.0;
  /// Indices of the disc's rings, below the upper pad and above the lower pad.
  std::array<std::size_t, 2> rings;
  PadContact contact;
  /// [n_pad_modes x 3] motion (r, t, z) of the upper plate at the point, by each coordinate.
  Eigen::MatrixX3d upper;
  Eigen::MatrixX3d lower;  ///< [n_pad_modes x 3] motion of the lower plate
};

/// All pads of a scene: their contact points, and the modes of plates and calipers on their
/// suspensions, b'' + C b' + diag(omega^2) b = forces. b is measured from the sliding equilibrium
/// in which the points of a pad share its preload equally, as worn pads do.
struct PadSystem {
  std::vector<PointPair> points;
  Eigen::VectorXd omega;        ///< [n_pad_modes] rad/s; empty when all pads are massless
  Eigen::MatrixXd C;            ///< [n_pad_modes x n_pad_modes] 1/s
  int disc_rows = middle_rows;  ///< rows of a point pair that belong to the disc; see pair_rows.hpp

  Eigen::Index n_modes() const { return omega.size(); }
  /// Number of rows of a point pair.
  int rows() const { return disc_rows + (n_modes() > 0 ? plate_rows : 0); }
  /// Number of pad pairs.
  std::size_t n_pads() const { return points.empty() ? 0 : points.back().pad + 1; }
};

/// The pads of a scene.
/// @param rings  rings of the disc; pads without a grid use the first, or the first two
/// @throws chladni::Error for a body without a suspension, a caliper or shim without an axial
///         suspension of the plate, a grid on a ring that the disc does not have, friction that
///         depends on an unknown pressure, and two rings of a pair at the same height.
PadSystem pad_system(const SquealOptions& options, const std::vector<RingPlace>& rings);

/// The pads of a scene on one ring with this radius (m).
PadSystem pad_system(const SquealOptions& options, double radius);

/// The disc with the pad modes as additional last coordinates, which do not move its rings.
InertialDisc with_pads(InertialDisc disc, const PadSystem& pads);

/// Shapes of disc and pad modes at a point pair.
/// @param S  [n_disc_modes x pads.disc_rows] shapes of the disc
PairShapes pair_shapes(const Eigen::MatrixXd& S, const PadSystem& pads, const PointPair& point);

/// All data of the force at a point pair except the motion.
struct BrakePoint {
  PadContact contact;
  PairShapes S;
  RestStates at_rest;
};

/// Data of a point pair.
/// @param S      [n_disc_modes x pads.disc_rows] shapes of the disc
/// @param speed  rotation speed, rad/s
/// @throws chladni::Error from require_in_table.
BrakePoint brake_point(const Eigen::MatrixXd& S, const PadSystem& pads, const PointPair& point,
                       double speed);

/// States of both pads of a point pair and their forces in the order of its rows.
struct PairContact {
  ContactResult<double> states;
  PairVector<double> force;
};
/// Evaluates the contact law at a point pair.
/// @param speed  rotation speed, rad/s
PairContact contact_at(const BrakePoint& point, const PointMotion& motion, double speed);

/// Modes of disc and pads without contact: q'' + C q' + diag(omega^2) q = 0 in the frame that
/// rotates with the disc.
struct FreeBrake {
  Eigen::VectorXd omega;  ///< rad/s
  Eigen::MatrixXd C;      ///< 1/s, including the Coriolis terms of the disc
};
/// The modes of disc and pads at a rotation speed (rad/s).
FreeBrake free_brake(const Disc& disc, const PadSystem& pads, double speed);

/// Derivatives of `pair_forces` at rest: D_a by the motion, D_p by its rates.
struct PairDerivatives {
  Eigen::MatrixXd D_a;  ///< [rows x rows]
  Eigen::MatrixXd D_p;  ///< [rows x rows]
};
/// The derivatives at a rotation speed (rad/s), by complex steps.
/// @throws chladni::Error from require_in_table.
PairDerivatives pair_derivatives(const PadContact& pad, double speed, int rows);

/// States of each pad pair from those of its points: forces are summed and motions averaged.
std::vector<ContactResult<double>> by_pad(const PadSystem& pads,
                                          const std::vector<ContactResult<double>>& points);

}  // namespace chladni::squeal

/// Plates and calipers on their suspensions, without contact.

namespace chladni::squeal {

/// One degree of freedom of a plate.
struct PlateFreedom {
  /// 0, 1, 2: translation (radial, tangential, axial); 3, 4, 5: rotation about these.
  int direction;
  double inertia;  ///< kg or kg m^2
  Suspension suspension;
};

/// The degrees of freedom of a plate that have a suspension, by ascending direction.
/// @param shim  damping layer behind the plate
std::vector<PlateFreedom> freedoms(const PadBody& body, const std::optional<Shim>& shim = {});

/// Mass, damping and stiffness of M u'' + C u' + K u = f for plates and calipers.
struct PadMatrices {
  Eigen::MatrixXd M, C, K;
};

/// Number of coordinates of a pad pair: those of the upper plate, the lower plate and the caliper.
Eigen::Index n_coordinates(const PadPair& pad);

/// The matrices of all pads in their order; M is diagonal.
PadMatrices pad_matrices(const SquealOptions& options);

/// Contact places above and below a ring in the middle surface of a plate.
/// @param thickness  of the plate, m
/// @param radius     of the ring, m
std::array<PadFace, 2> faces_of_plate(double thickness, double radius);

/// Contact data of one pad pair of the scene.
/// @param faces  places of the upper and of the lower pad
PadContact pad_contact(const SquealOptions& options, const PadPair& pad,
                       const std::array<PadFace, 2>& faces);

/// The rings under the upper pad and above the lower pad of a pair: two rings, or one twice.
struct RingPair {
  std::array<std::size_t, 2> rings;  ///< indices of the disc's rings, upper first
  std::array<PadFace, 2> faces;
};

/// The rings of the study, used by pads without a grid and by the centres of plates.
/// @param rings  rings of the disc, those of the study first
/// @throws chladni::Error when the two rings lie at the same height.
RingPair study_pair(const SquealOptions& options, const std::vector<RingPlace>& rings);

/// The ring pairs of a pad's grid.
/// @param pad  index of the pad, for messages
/// @throws chladni::Error when the disc does not have a ring, or the two rings of a pair lie at the
///         same height.
std::vector<RingPair> ring_pairs(const SquealOptions& options, const PadGrid& grid,
                                 const std::vector<RingPlace>& rings, std::size_t pad);

/// Modes of plates and calipers in mass-scaled displacements, y = Psi b. Psi diag(omega) Psi^T is
/// the square root of their stiffness matrix.
/// @return [n_pad_modes x n_pad_modes] orthogonal
Eigen::MatrixXd pad_basis(const SquealOptions& options);

/// The state matrix in coordinates that depend smoothly on the pad parameters: (K^(1/2) y, y') in
/// place of the pad modes, whose signs, and for equal plates whose combinations, are arbitrary. Its
/// eigenvalues are those of `state_matrix`.
Eigen::MatrixXd smooth_state_matrix(const InertialDisc& disc, const SquealOptions& options,
                                    double speed);

/// Mode shapes of a rotating disc at the point pairs of its pads. Those of a patch are means over
/// it, as if the shapes were the same along the radius.
class PointShapes {
 public:
  explicit PointShapes(const Disc& disc);

  /// Shapes when the disc has rotated by `angle` (rad); valid until the next call.
  /// @return [n_modes x disc rows of a point pair]
  const Eigen::MatrixXd& at(const PointPair& point, double angle);

 private:
  std::vector<RingShapes>& with_patch(double patch);

  std::vector<DiscRing> disc_rings_;
  std::map<double, std::vector<RingShapes>> rings_;  ///< by the patch
  Eigen::MatrixXd both_;                             ///< shapes of two rings side by side
};

/// Mode shapes of the disc in the inertial frame at a point pair.
/// @return [n_modes x disc rows of a point pair]
Eigen::MatrixXd shapes_at(const InertialDisc& disc, const PointPair& point);

}  // namespace chladni::squeal
