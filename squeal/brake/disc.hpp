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

/// Compliance of the contact rings by modes far above the frequency range of interest, which
/// respond without inertia. A force at the angle alpha displaces the angle theta by Re sum_d C[d]
/// exp(i d (theta - alpha)), averaged over all positions of the disc.
struct RingCompliance {
  /// [n_harmonics][m n_rings x m n_rings] compliance of the m = 3 or 5 functions w, g_r, g_t, v_r,
  /// v_t of each ring by their forces: m/N, 1/N, 1/(N m).
  std::vector<Eigen::MatrixXcd> C;
  std::vector<int> mode_numbers;  ///< 1-based numbers of the body's modes
  double lowest_omega = 0.0;      ///< lowest angular frequency of these modes, rad/s

  bool empty() const { return C.empty(); }
};

/// Estimated relative errors of the modes.
struct ModeErrors {
  Eigen::VectorXd mesh = {};  ///< [n_modes] error of omega by the mesh; empty if unknown
  /// [6 x n_modes] error of the ring motion by the mesh, from Certificate::mesh_shape_errors; empty
  /// if unknown.
  Eigen::MatrixXd mesh_shapes = {};
  Eigen::VectorXd reduction = {};  ///< [n_modes] error of omega by the reduction; empty if unknown
  std::optional<double> responses = {};  ///< error of the body's responses by missing modes
  /// [3 x n_rings] OwnCompliances::growth of the rings; empty if unknown
  Eigen::MatrixXd mesh_compliances = {};
  Eigen::Index n_harmonics = 0;  ///< of the rings, cosine and sine known
  /// Angular frequency of the last mode with known errors, rad/s; modes beyond it have zeros.
  double range = 0.0;
};

/// The disc of a squeal study in the frame that rotates with it,
/// q'' + (C + 2 Omega G) q' + diag(omega^2) q = Q, with the mode shapes on its contact rings. Pads
/// without a grid are on the first ring.
struct Disc {
  std::vector<DiscRing> rings;
  std::vector<int> mode_numbers;  ///< [n_modes] 1-based numbers of the body's modes
  Eigen::VectorXd omega;          ///< [n_modes] rad/s
  Eigen::MatrixXd C;              ///< [n_modes x n_modes] 1/s; zero when undamped
  /// [n_modes x n_modes] skew-symmetric, 1: G_ij = int rho phi_i . (e_z x phi_j) dV; Coriolis
  /// forces add 2 Omega G q'. Zero when the body file does not contain it.
  Eigen::MatrixXd G;
  RingCompliance compliance = {};  ///< compliance of the modes without inertia
  /// Upper end of the frequency range in which the modes are those of the disc, rad/s; interface
  /// modes beyond it stand for many others.
  double range = std::numeric_limits<double>::infinity();
  /// 1-based numbers of modes left out because they do not move the pads.
  std::vector<int> still = {};
  /// 1-based numbers of modes left out because their sign changes from node to node of the rings,
  /// which show one of the two modes of such a pair only.
  std::vector<int> alternating = {};
  /// 1-based numbers of modes beyond the certified frequencies that follow the pads without inertia
  /// because the disc is not axisymmetric with them.
  std::vector<int> alone = {};
  ModeErrors errors = {};
  std::vector<ModeFigure> figures = {};  ///< [n_modes]; empty if unknown
  bool keeps_asymmetry = false;          ///< see SquealOptions

  Eigen::Index n_modes() const { return omega.size(); }
};

/// The disc of `body` with these contact rings. Without a choice of modes, or with a choice by
/// nodal diameters, modes that do not move the rings axially are left out, and those whose sign
/// changes from node to node. Without a choice, modes
/// above `ModeChoice::quasi_static_above` contribute their compliance only; if that is absent, this
/// holds beyond the body's range for interface modes, and for the modes beyond the certificate of a
/// reduction that was made for responses. Such modes represent the static response of all modes
/// beyond the range, at frequencies that the disc does not have. The same holds for modes beyond
/// the certified frequencies (in a body of all modes without them, beyond half of the highest one)
/// if the disc is axisymmetric without them alone. Other modes keep their inertia, and a mode of
/// unknown kind counts as one of the disc.
/// @throws chladni::Error for an unknown ring, two rings with one name, a mode number that is out
///         of range or repeated, a number of nodal diameters without a pair of modes, rigid-body
///         modes (the body is not held), and modes that do not move the ring.
Disc make_disc(const mbs_export::ModalBody& body, const RingChoice& rings, const ModeChoice& modes);

/// The disc of `body` whose pads touch one ring, with its axial motion; see make_disc.
Disc disc_on_ring(const mbs_export::ModalBody& body, const std::string& ring,
                  const ModeChoice& modes);

/// Notes on modes that do not take part in the motion, one sentence each, such as "60 modes above
/// 17048 Hz follow the pads without inertia"; empty when all take part.
std::vector<std::string> notes_of(const Disc& disc);

/// The rings of the study, followed by those that only the grids of pads name.
RingChoice ring_choice(const SquealOptions& options);

/// Names, radii and heights of the disc's rings.
std::vector<RingPlace> ring_places(const Disc& disc);

/// Mode shapes at the angle `theta` (rad) of the first ring.
Shapes shapes_at(const Disc& disc, double theta);

/// Number of nodal diameters of each mode: its dominant harmonic along the rings.
std::vector<int> nodal_diameters(const Disc& disc);

}  // namespace chladni::squeal
