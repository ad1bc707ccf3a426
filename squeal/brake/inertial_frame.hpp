#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// A contact ring of an axisymmetric disc, with the amplitudes of the modes on it.
struct InertialRing {
  std::string name;
  double radius;        ///< m
  Eigen::VectorXd U;    ///< [n_modes] amplitude of the axial displacement W, m per unit of a
  Eigen::VectorXd U_r;  ///< [n_modes] amplitude of the radial slope W_r, rad per unit of a
  /// [n_modes] amplitude of the circumferential slope, W_t = U_t (-sin, cos)(n theta), U_t for
  /// n = 0, rad per unit of a.
  Eigen::VectorXd U_t;
  /// [n_modes] amplitudes of the in-plane displacements, V_r with the angle like W and V_t like
  /// W_t, m per unit of a; empty when they do not act on the pads.
  Eigen::VectorXd V_r = {}, V_t = {};
  double height = 0.0;  ///< z, m
};

/// Pointers to U, U_r, U_t and, if present, V_r, V_t.
std::vector<Eigen::VectorXd*> amplitudes_of(InertialRing& ring);

/// An axisymmetric disc in the inertial frame, where its equations do not depend on time:
/// a' = -Omega D a + p,  p' = -Omega D p - diag(omega^2) a - (C + 2 Omega G) p + Q. The modes are
/// pairs U cos(n theta), U sin(n theta), or single modes with n = 0.
struct InertialDisc {
  std::vector<InertialRing> rings;  ///< see Disc
  /// [n_modes] n of each coordinate; the two of a pair are adjacent.
  std::vector<int> nodal_diameters;
  Eigen::VectorXd omega;    ///< [n_modes] rad/s, mean of each pair
  Eigen::MatrixXd C;        ///< [n_modes x n_modes] 1/s, mean over the circumference
  Eigen::MatrixXd G;        ///< [n_modes x n_modes] 1, mean over the circumference; see Disc
  Eigen::MatrixXd D;        ///< d/dtheta in these coordinates: [0 n; -n 0] for each pair
  Eigen::MatrixXd R;        ///< orthogonal, with q = R a when the two frames coincide
  double largest_split;     ///< largest relative frequency difference within a pair
  double largest_impurity;  ///< largest relative impurity of the mode shapes; see impurity_limit
  /// The same of modes whose errors of the mesh and the reduction tell as much of their shapes:
  /// modes of an irregular mesh whose frequencies are near one another mix.
  double explained_impurity = 0.0;
  /// Largest difference of the decay rates within a pair, 1/s, which the mean over the
  /// circumference removes.
  double damping_spread = 0.0;
  double damping_contrast = 0.0;   ///< that difference relative to the pair's mean decay rate
  RingCompliance compliance = {};  ///< see Disc
  ModeErrors errors = {};          ///< see Disc; the same for both modes of a pair

  Eigen::Index n_modes() const { return omega.size(); }
};

/// Largest allowed deviation of a mode shape from a pure harmonic, relative to its amplitude on the
/// ring, where the mode's own errors do not explain it. A mesh without rotational symmetry causes
/// 1e-6 to 1e-3, a disc with vanes or slots much more.
inline constexpr double impurity_limit = 0.02;

/// Factor by which split and impurity of modes beyond Disc::range, whose frequencies are not those
/// of the disc, count less.
inline constexpr double beyond_range = 10.0;

/// Largest allowed relative frequency difference within a pair.
inline constexpr double split_limit = 0.01;

/// Of the squared motion of each mode on the rings the share that no pair of the disc's modes has,
/// [n_modes]: a mode without a partner has nearly all of it, one among asymmetric ones some of it.
Eigen::VectorXd unpaired_shares(const Disc& disc);

/// The disc in the inertial frame.
/// @throws chladni::Error when the disc is not axisymmetric (impurity, split or damping above its
///         limit, with the value), or when only one mode of a pair was chosen.
InertialDisc inertial_disc(const Disc& disc);

/// The reason why the disc has no inertial frame, such as "its damping changes around the
/// circumference by 0.21 (allowed: 0.02)"; absent when it has one.
std::optional<std::string> asymmetry(const Disc& disc);

/// The disc in the inertial frame, absent when it is not axisymmetric.
std::optional<InertialDisc> find_inertial_disc(const Disc& disc);

/// exp(-Omega t D) a: the inertial coordinates, after the rotation by an angle, of a deformation
/// that is constant in the disc.
/// @param angle  Omega t, rad
Eigen::VectorXd turned(const InertialDisc& disc, const Eigen::VectorXd& a, double angle);

/// Names, radii and heights of the disc's rings.
std::vector<RingPlace> ring_places(const InertialDisc& disc);

/// Mode shapes at the inertial angle `theta` (rad) on a ring of the disc; they do not depend on
/// time.
Shapes shapes_at(const InertialDisc& disc, const InertialRing& ring, double theta);
/// Mode shapes at the inertial angle `theta` (rad) on the first ring.
Shapes shapes_at(const InertialDisc& disc, double theta);

}  // namespace chladni::squeal
