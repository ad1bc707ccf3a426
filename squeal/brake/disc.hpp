#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// What each mode does at one point of the contact ring.
struct Shapes {
  Eigen::VectorXd W;    ///< [n_modes] displacement along the axis, m per unit of q
  Eigen::VectorXd W_r;  ///< [n_modes] radial slope, rad per unit of q
  Eigen::VectorXd W_t;  ///< [n_modes] circumferential slope, rad per unit of q
};

/// [n_modes x 3] W, W_r, W_t side by side.
inline Eigen::MatrixX3d matrix_of(const Shapes& shapes)
{
  Eigen::MatrixX3d S(shapes.W.size(), 3);
  S << shapes.W, shapes.W_r, shapes.W_t;
  return S;
}

/// A function of the ring angle for each mode, f_i(theta) = sum_k cosine_ki cos(k theta)
/// + sine_ki sin(k theta): the trigonometric interpolation of values at n equally spaced nodes.
struct Harmonics {
  Eigen::MatrixXd cosine;  ///< [n/2 + 1 x n_modes]
  Eigen::MatrixXd sine;    ///< [n/2 + 1 x n_modes]
};

/// What forces on the contact rings do to them through modes so far above the range of interest
/// that they follow without inertia: the displacement at the angle theta by a force at alpha is
/// Re sum_d C[d] exp(i d (theta - alpha)), the mean over all positions of the disc.
struct RingCompliance {
  /// [n_harmonics][3 n_rings x 3 n_rings] of (w, g_r, g_t) of each ring by (F_w, F_r, F_t): m/N,
  /// 1/N, 1/(N m).
  std::vector<Eigen::MatrixXcd> C;
  std::vector<int> mode_numbers;  ///< 1-based in the body
  double lowest_omega = 0.0;      ///< of these modes, rad/s

  bool empty() const { return C.empty(); }
};

/// A contact ring and the mode shapes along it.
struct DiscRing {
  std::string name;
  double radius;    ///< m
  Harmonics W;      ///< m per unit of q
  Harmonics W_r;    ///< rad per unit of q
  Harmonics W_t;    ///< rad per unit of q
  int n_nodes = 0;  ///< that the harmonics interpolate; 0 when they are no interpolation

  /// Harmonics of which both cosine and sine are known: through n / 2 of n nodes goes one function
  /// only, cos(n theta / 2), which no disc that turns can have alone.
  Eigen::Index n_whole_harmonics() const
  {
    return n_nodes > 0 && n_nodes % 2 == 0 ? W.cosine.rows() - 1 : W.cosine.rows();
  }
};

/// Name and radius (m) of a contact ring.
struct RingPlace {
  std::string name;
  double radius;
};

/// The disc of a squeal study, in the frame that rotates with it:
/// q'' + (C + 2 Omega G) q' + diag(omega^2) q = Q, with the mode shapes along its contact rings, of
/// which the first is that of pads without a grid.
struct Disc {
  std::vector<DiscRing> rings;
  std::vector<int> mode_numbers;  ///< [n_modes] 1-based in the body
  Eigen::VectorXd omega;          ///< [n_modes] rad/s
  Eigen::MatrixXd C;              ///< [n_modes x n_modes] 1/s, zero when undamped
  /// [n_modes x n_modes] 1, skew: G_ij = int rho phi_i . (e_z x phi_j) dV, by which Coriolis forces
  /// add 2 Omega G q'. Zero when the body does not hold it.
  Eigen::MatrixXd G;
  RingCompliance compliance = {};  ///< of modes that follow the pads without inertia
  /// Up to which the modes are those of the disc, rad/s; beyond it interface modes stand for
  /// others.
  double range = std::numeric_limits<double>::infinity();
  std::vector<int> still = {};  ///< 1-based, of modes left out: no pad sees them

  Eigen::Index n_modes() const { return omega.size(); }
};

/// The disc of `body` that touches the pads at the rings of these names. With no choice or a choice
/// by nodal diameters, modes that do not move the ring along the axis are left out: no pad sees
/// them. With no choice, modes beyond `ModeChoice::quasi_static_above` give it their compliance
/// alone; where that is not given, interface modes beyond the body's range do. They stand for what
/// all modes beyond the range do slowly, at frequencies that the disc does not have; modes of the
/// disc keep their inertia, and a mode of unknown kind counts as one.
/// @throws chladni::Error for an unknown ring, two rings of one name, a mode number out of range or
/// given twice, a number
///         of nodal diameters that no pair of modes has, rigid-body modes (the body is not held),
///         and modes that do not move the ring.
Disc make_disc(const mbs_export::ModalBody& body, const std::vector<std::string>& rings,
               const ModeChoice& modes);
Disc make_disc(const mbs_export::ModalBody& body, const std::string& ring, const ModeChoice& modes);

/// Which modes have no part in the motion, a sentence each: "60 modes above 17048 Hz follow the
/// pads without inertia"; empty when all have one.
std::vector<std::string> notes_of(const Disc& disc);

/// The ring of the study, then those that the grids of its pads name beside it.
std::vector<std::string> ring_names(const SquealOptions& options);

std::vector<RingPlace> ring_places(const Disc& disc);

/// Shapes at the angle `theta` (rad) of a ring, exact for harmonics below half its nodes.
Shapes shapes_at(const DiscRing& ring, double theta);
/// On the first ring.
Shapes shapes_at(const Disc& disc, double theta);

/// Trigonometric interpolation of the columns of `values` [n x n_modes], which are given at the
/// ascending, equally spaced `angles` [n] (rad).
/// @throws chladni::Error when the angles are not equally spaced over the circle.
Harmonics harmonics_of(const Eigen::VectorXd& angles, const Eigen::MatrixXd& values);

/// The dominant harmonic of each mode along the rings, i.e. its number of nodal diameters.
std::vector<int> nodal_diameters(const Disc& disc);

}  // namespace chladni::squeal
