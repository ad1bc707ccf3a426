#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "squeal/brake/disc.hpp"

namespace chladni::squeal {

/// A contact ring of an axisymmetric disc.
struct InertialRing {
  std::string name;
  double radius;        ///< m
  Eigen::VectorXd U;    ///< [n_modes] amplitude of W, m per unit of a
  Eigen::VectorXd U_r;  ///< [n_modes] amplitude of W_r, rad per unit of a
  Eigen::VectorXd
      U_t;  ///< [n_modes] W_t = U_t (-sin, cos)(n theta), U_t for n = 0, rad per unit of a
  /// [n_modes] of the displacements in the plane, V_r like W and V_t like W_t, m per unit of a;
  /// empty where no pad feels them
  Eigen::VectorXd V_r = {}, V_t = {};
  double height = 0.0;  ///< z, m
};

/// U, U_r, U_t and, where there are some, V_r, V_t.
std::vector<Eigen::VectorXd*> amplitudes_of(InertialRing& ring);

/// An axisymmetric disc seen from the inertial frame, where its equations do not depend on time:
/// a' = -Omega D a + p,  p' = -Omega D p - diag(omega^2) a - (C + 2 Omega G) p + Q.
/// Modes come as pairs U cos(n theta), U sin(n theta), or alone for n = 0.
struct InertialDisc {
  std::vector<InertialRing> rings;   ///< as in Disc
  std::vector<int> nodal_diameters;  ///< [n_modes] n of each coordinate; pairs are neighbours
  Eigen::VectorXd omega;             ///< [n_modes] rad/s, averaged over each pair
  Eigen::MatrixXd C;                 ///< [n_modes x n_modes] 1/s, averaged over the circumference
  Eigen::MatrixXd G;                 ///< [n_modes x n_modes] 1, averaged likewise; see Disc
  Eigen::MatrixXd D;                 ///< d/dtheta in the coordinates: [0 n; -n 0] for each pair
  Eigen::MatrixXd R;                 ///< orthogonal: q = R a when the two frames coincide
  double largest_split;              ///< of the frequencies of a pair, relative
  double largest_impurity;           ///< of the mode shapes on the ring, relative; see below
  /// Largest difference of the decay rates of the two modes of a pair, 1/s, which the mean over the
  /// circumference takes away.
  double damping_spread = 0.0;
  double damping_contrast = 0.0;   ///< the same over the mean rate of the pair
  RingCompliance compliance = {};  ///< as in Disc
  ModeErrors errors = {};          ///< as in Disc, of the pairs

  Eigen::Index n_modes() const { return omega.size(); }
};

/// How far a mode shape may be from a pure harmonic, relative to its amplitude on the ring: a mesh
/// that is not rotationally symmetric leaves 1e-6 to 1e-3, a disc with vanes or slots much more.
inline constexpr double impurity_limit = 0.02;

/// What modes beyond Disc::range, which have no frequency of the disc, count less in both.
inline constexpr double beyond_range = 10.0;

/// How far the two frequencies of a pair may be apart, relative.
inline constexpr double split_limit = 0.01;

/// The disc in the inertial frame.
/// @throws chladni::Error when the disc is not axisymmetric (impurity, split or damping beyond the
///         limits, by how much), or when only one mode of a pair was chosen.
InertialDisc inertial_disc(const Disc& disc);

/// Why the disc has no inertial frame, "its damping changes around the circumference by 0.21
/// (allowed: 0.02)"; absent when it has one.
std::optional<std::string> asymmetry(const Disc& disc);

/// The disc in the inertial frame, absent when it is not axisymmetric.
std::optional<InertialDisc> find_inertial_disc(const Disc& disc);

/// exp(-Omega t D) a: the inertial coordinates at time t of a point that is at rest in the disc.
/// @param angle  Omega t, rad
Eigen::VectorXd turned(const InertialDisc& disc, const Eigen::VectorXd& a, double angle);

std::vector<RingPlace> ring_places(const InertialDisc& disc);

/// Shapes at the inertial angle `theta` (rad) on a ring of the disc; these do not depend on time.
Shapes shapes_at(const InertialDisc& disc, const InertialRing& ring, double theta);
/// On the first ring.
Shapes shapes_at(const InertialDisc& disc, double theta);

}  // namespace chladni::squeal
