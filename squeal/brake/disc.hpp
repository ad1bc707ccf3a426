#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/modal_body.hpp"
#include "squeal/brake/disc_ring.hpp"
#include "squeal/brake_options.hpp"

namespace chladni::squeal {

/// Description of a mode from its motion over the whole disc.
struct ModeFigure {
  /// Number of nodal circles: sign changes of the axial motion along the radius. Absent when the
  /// body has no picture, and for modes that are mainly in-plane.
  std::optional<int> circles = {};
  /// In-plane fraction of the kinetic energy; absent when the body has no mass integrals.
  std::optional<double> in_plane = {};
};

/// Descriptions of all modes of a body.
/// @param diameters  [n_modes] nodal diameters
std::vector<ModeFigure> mode_figures(const mbs_export::ModalBody& body,
                                     const std::vector<int>& diameters);

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
/// if the disc is axisymmetric without them alone, and with a body of all modes where it is not
/// axisymmetric at all. Other modes keep their inertia, and a mode of
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

/// What the errors of growth rates and critical speeds lack although the body knows errors by the
/// mesh, and why; absent where they lack nothing, and where the body knows none.
/// @param disc    made of `body` by make_disc
/// @param choice  of its modes
std::optional<std::string> note_of_lacking_errors(const Disc& disc,
                                                  const mbs_export::ModalBody& body,
                                                  const ModeChoice& choice);

/// The rings of the study, followed by those that only the grids of pads name.
RingChoice ring_choice(const SquealOptions& options);

/// Names, radii and heights of the disc's rings.
std::vector<RingPlace> ring_places(const Disc& disc);

/// Mode shapes at the angle `theta` (rad) of the first ring.
Shapes shapes_at(const Disc& disc, double theta);

/// Number of nodal diameters of each mode: its dominant harmonic along the rings.
std::vector<int> nodal_diameters(const Disc& disc);

/// The roles of a body's modes in a study.
struct ModeParts {
  std::vector<int> dynamic;       ///< 0-based, with stiffness and inertia
  std::vector<int> quasi_static;  ///< 0-based, with their compliance only
  std::vector<int> alone = {};    ///< 0-based, of the quasi-static ones those without a partner
  std::vector<int> still;         ///< 1-based, left out because they do not move the pads
  /// 1-based, left out because they move the rings with harmonic n / 2 of their n nodes
  std::vector<int> alternating;
};

/// Upper end of the frequency range for which a body with interface modes was made, rad/s: the
/// limit of its tolerance, or its highest other mode. Infinite for bodies without interface modes,
/// and without other modes where there is no tolerance.
double range_of(const mbs_export::ModalBody& body);

/// The end of what a reduction knows of its modes, rad/s: the certified frequencies or, of a body
/// of all modes, half of the highest one; infinite where neither is known.
double end_of_known(const Disc& disc, const mbs_export::ModalBody& body);

/// Assigns a role to each mode.
/// @param disc  the disc of `body` with all modes
/// @throws chladni::Error as make_disc.
ModeParts mode_parts(const Disc& disc, const mbs_export::ModalBody& body, const ModeChoice& choice);

/// Checks that the nodes of each ring tell the modes of the disc from others. A mode of n nodal
/// diameters looks on N < 2 n + 1 nodes like one of |n - m N| diameters with another slope along
/// the ring, by which it is found where the nodes rotate; of N / 2 diameters the ring shows one
/// mode of a pair, which takes no part (`ModeParts::alternating`). Modes of interfaces and those
/// beyond the range do not count: they stand for many others.
/// @param disc  made of `body`
/// @throws chladni::Error with the mode, and the number of nodes that suffices for all of them.
void refuse_aliases(const Disc& disc, const mbs_export::ModalBody& body);

/// Harmonics of the modes on the contact rings: row i of `c[d]` has the functions of mode i on each
/// ring as lengths (`functions_of`), Re(c exp(i d theta)). The harmonic n / 2 of a ring with n
/// nodes is left out, because its sine is unknown.
struct RingHarmonics {
  std::vector<Eigen::MatrixXcd> c;  ///< [d][n_modes x functions of all rings]

  /// [n_modes] sum of squares over all harmonics and functions.
  Eigen::VectorXd squares() const;
  /// [n_harmonics x n_modes] sum of squares of each harmonic over all functions.
  Eigen::MatrixXd squares_by_harmonic() const;
};

/// The harmonics of the modes on these rings.
RingHarmonics ring_harmonics(const std::vector<DiscRing>& rings);

/// The skew-symmetric matrix S that rotates modal coordinates as a rotation of the disc does, in
/// the least-squares sense. If the space of modes is closed under rotation and the disc is
/// axisymmetric, S c[d] / d = i c[d] on all rings, and S commutes with the stiffness; the second
/// condition has the weight (omega_i / omega_j - omega_j / omega_i)^2 for each entry. The
/// eigenvalues of S are then +-i d. The partners of modes are found in any order, even when modes
/// of close frequencies mix.
/// @param omega  [n_modes] rad/s
Eigen::MatrixXd rotation_generator(const RingHarmonics& harmonics, const Eigen::VectorXd& omega);

/// The modal coordinates with d nodal diameters, from the eigenvectors of a generator.
struct HarmonicSpace {
  int d;
  /// [n_modes x m] orthonormal. For d > 0 the columns e have S e = i d e, and their real and
  /// imaginary parts span 2 m dimensions; for d = 0 they are real.
  Eigen::MatrixXcd E;
};

/// The spaces of all d by ascending d, which together are the whole space; eigenvalues of S are
/// rounded to integers.
std::vector<HarmonicSpace> harmonic_spaces(const Eigen::MatrixXd& S);

}  // namespace chladni::squeal
