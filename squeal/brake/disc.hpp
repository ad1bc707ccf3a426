#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/brake/disc_ring.hpp"
#include "squeal/brake/mode_figures.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// What forces on the contact rings do to them through modes so far above the range of interest
/// that they follow without inertia: the displacement at the angle theta by a force at alpha is
/// Re sum_d C[d] exp(i d (theta - alpha)), the mean over all positions of the disc.
struct RingCompliance {
  /// [n_harmonics][m n_rings x m n_rings] of the m = 3 or 5 functions of each ring, w, g_r, g_t,
  /// v_r, v_t, by their forces: m/N, 1/N, 1/(N m).
  std::vector<Eigen::MatrixXcd> C;
  std::vector<int> mode_numbers;  ///< 1-based in the body
  double lowest_omega = 0.0;      ///< of these modes, rad/s

  bool empty() const { return C.empty(); }
};

/// What is known of the errors of modes, relative.
struct ModeErrors {
  Eigen::VectorXd mesh = {};  ///< [n_modes] of omega by the mesh; empty where unknown
  /// [6 x n_modes] of the rings by the mesh, as Certificate::mesh_shape_errors; empty where unknown
  Eigen::MatrixXd mesh_shapes = {};
  Eigen::VectorXd reduction = {};  ///< [n_modes] of omega by the reduction; empty where unknown
  std::optional<double> responses = {};  ///< of the body by the modes that it lacks
  double range =
      0.0;  ///< rad/s of the last mode whose errors are known; those beyond it have zeros
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
  ModeErrors errors = {};
  std::vector<ModeFigure> figures = {};  ///< [n_modes], or empty where nothing is known of them
  bool keeps_asymmetry = false;          ///< see SquealOptions

  Eigen::Index n_modes() const { return omega.size(); }
};

/// The disc of `body` that touches the pads at these rings. With no choice or a choice
/// by nodal diameters, modes that do not move the ring along the axis are left out: no pad sees
/// them. With no choice, modes beyond `ModeChoice::quasi_static_above` give it their compliance
/// alone; where that is not given, interface modes beyond the body's range do. They stand for what
/// all modes beyond the range do slowly, at frequencies that the disc does not have; modes of the
/// disc keep their inertia, and a mode of unknown kind counts as one.
/// @throws chladni::Error for an unknown ring, two rings of one name, a mode number out of range or
/// given twice, a number
///         of nodal diameters that no pair of modes has, rigid-body modes (the body is not held),
///         and modes that do not move the ring.
Disc make_disc(const mbs_export::ModalBody& body, const RingChoice& rings, const ModeChoice& modes);

/// The disc of `body` that touches the pads at one ring, by its axial motion; see `make_disc`.
Disc disc_on_ring(const mbs_export::ModalBody& body, const std::string& ring,
                  const ModeChoice& modes);

/// Which modes have no part in the motion, a sentence each: "60 modes above 17048 Hz follow the
/// pads without inertia"; empty when all have one.
std::vector<std::string> notes_of(const Disc& disc);

/// The rings of the study, then those that the grids of its pads name beside them.
RingChoice ring_choice(const SquealOptions& options);

std::vector<RingPlace> ring_places(const Disc& disc);

/// On the first ring.
Shapes shapes_at(const Disc& disc, double theta);

/// The dominant harmonic of each mode along the rings, i.e. its number of nodal diameters.
std::vector<int> nodal_diameters(const Disc& disc);

}  // namespace chladni::squeal
