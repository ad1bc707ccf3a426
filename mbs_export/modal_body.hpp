#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

enum class ModeKind { rigid, constrained, interface };

/// A contact ring of the body: attachment nodes on a circle about the z axis, ordered by angle, and
/// the motion of each mode there. Slopes come from the nodal rotations of the shear-flexible shell:
/// W_r = -theta_t and W_t = theta_r (unit normal (-W_r, -W_t, 1) to first order); zero where the
/// nodes have no rotations.
struct ContactRing {
  std::string name;
  double radius;           ///< m
  double height;           ///< z of the circle, m
  std::vector<int> nodes;  ///< indices into `attachment_nodes`
  Eigen::VectorXd angles;  ///< [n], rad, ascending, equally spaced
  Eigen::MatrixXd W;       ///< [n x n_modes] displacement u_z, m per unit of q
  Eigen::MatrixXd W_r;     ///< [n x n_modes] radial slope, rad per unit of q
  Eigen::MatrixXd W_t;     ///< [n x n_modes] circumferential slope, rad per unit of q
};

/// How the modes were chosen, for a report.
struct Preparation {
  int n_constrained_modes = 0;  ///< number of modes of the held body
  int n_partners = 0;  ///< modes kept in addition, so that modes of one frequency stay together
  int n_interface_dropped = 0;  ///< interface modes that depended on others
  int n_massless = 0;           ///< reduced coordinates without mass, which no mode represents
  double rigid_residual = 0.0;  ///< energy of the rigid modes over the first elastic omega^2
  /// Condition number of Q_dd with rows of unit length, which removes their units; absent in some
  /// files.
  std::optional<double> condition_directions = {};
};

/// A step of a selection by tolerance, and the basis after it.
struct SelectionStep {
  std::string added;  ///< "modes 7, 8" or "interface modes track.z, 3 diameters, at 1500 Hz"
  int n_modes;        ///< number of constrained and rigid modes
  int n_interface;    ///< number of interface modes
  double error;       ///< largest relative error of the frequency responses

  int size() const { return n_modes + n_interface; }
};

/// Size against error of a selection by tolerance, without and with interface modes.
struct SelectionTable {
  double error;  ///< the tolerance
  /// Error of the reduced system against the FE model, in addition to the errors of the steps;
  /// absent if it is unknown.
  std::optional<double> of_reduction = {};
  double Omega_max;                ///< end of the range, rad/s
  std::vector<std::string> loads;  ///< loaded attachment DOFs; "track.z" for all nodes of a set
  std::vector<SelectionStep> modes_only;
  std::vector<SelectionStep> with_interface_modes;
};

/// What the modes of a body were condensed for; other motions of the body are lost.
struct Condensation {
  std::string brake;  ///< title of the scene of the assembly
  double highest;     ///< end of the band of its vibrations that are kept, rad/s
  double tolerance;   ///< asked for the eigenvalues of the assembly, relative
  double error;       ///< their largest relative error
};

/// A body of n_modes modal coordinates q with mass matrix I and stiffness diag(omega^2):
/// q'' + C q' + diag(omega^2) q = (mode shapes)^T forces. A squeal study needs nothing else.
struct ModalBody {
  std::string title;
  std::vector<ModeKind> kinds;  ///< [n_modes]
  Eigen::VectorXd omega;        ///< [n_modes], rad/s, ascending
  /// [n_modes x n_modes], 1/s, or [0 x 0]; includes the viscous equivalent of `H`
  /// (body_damping.hpp)
  Eigen::MatrixXd C;
  /// [n_modes x n_modes] structural damping, 1/s^2, or [0 x 0]: diag(omega^2) + i H in harmonic
  /// motion
  Eigen::MatrixXd H = {};
  std::vector<AttachmentNode> attachment_nodes;
  std::vector<AttachmentSet> sets;
  std::vector<std::string> fixed;    ///< the support of the scene, as "hub", "hub.z"
  Eigen::MatrixXd attachment_modes;  ///< [6 n_nodes x n_modes] u and theta of each node
  std::vector<ContactRing> rings;
  Picture picture;                 ///< its transformation is [3 n x n_modes]
  double mass;                     ///< kg
  Eigen::Vector3d centre_of_mass;  ///< m
  Eigen::Matrix3d inertia;         ///< about the centre of mass, kg m^2
  /// of the free reduced body, rad/s; the first n_rigid are zero
  Eigen::VectorXd free_frequencies;
  int n_rigid;            ///< number of rigid-body motions of the free body
  double condition_Q_dd;  ///< condition number of Q_dd in mode shifting; 1 if nothing is held
  /// number of rigid-body motions that `fixed` leaves; 0 for a held body
  int n_free_rigid = 0;
  Preparation preparation = {};
  std::vector<ResultantModes> resultants = {};  ///< in the modes, N or the like per unit of q
  /// with the mode shapes as phi_i, m per unit of q
  std::optional<MassIntegrals> mass_integrals = {};
  /// Present if the reduced system has it for `fixed`; 1 or 1/m per unit of the factor of each
  /// load.
  std::optional<Stiffening> stiffening = {};
  std::optional<SelectionTable> selection = {};          ///< if a tolerance chose the modes
  std::optional<SectorHarmonics> sector_harmonics = {};  ///< for a body of equal sectors
  std::optional<Condensation> condensation = {};         ///< of a body for one assembly alone
  /// of the reduced system; valid for the body if `fixed` is the same
  Certificate certificate = {};
  Provenance provenance;

  Eigen::Index n_modes() const { return omega.size(); }
};

/// phi^T H phi / phi^T K phi of each mode, 1; zero for modes without stiffness, empty without H.
Eigen::VectorXd loss_factors(const ModalBody& body);

/// The contact ring of this name.
/// @throws chladni::Error naming the rings that exist.
const ContactRing& find_ring(const ModalBody& body, const std::string& name);

/// The contact rings of a body, one for every attachment set of three or more nodes that lie at
/// equal angles on one circle about the z axis and whose displacement z is a master. With the nodal
/// rotations theta_r = theta . e_r and theta_t = theta . e_t the slopes are W_r = -theta_t and W_t
/// = theta_r; they are zero where the rotations x and y of a node are no masters.
/// @param attachment_modes  [6 n_nodes x n_modes]
std::vector<ContactRing> contact_rings(const ReducedSystem& reduced,
                                       const Eigen::MatrixXd& attachment_modes);

/// Circumferential Fourier coefficients: value(phi) = sum_n cosine_n cos(n phi) + sine_n sin(n
/// phi), n = 0 .. floor(N / 2), exact at the N nodes.
struct FourierCoefficients {
  Eigen::MatrixXd cosine;  ///< [floor(N / 2) + 1 x n_modes]
  Eigen::MatrixXd sine;    ///< [floor(N / 2) + 1 x n_modes]
};

/// The Fourier coefficients of values at equally spaced angles.
/// @param angles  [N], rad, equally spaced on the full circle
/// @param values  [N x n_modes] at these angles
FourierCoefficients fourier_coefficients(const Eigen::VectorXd& angles,
                                         const Eigen::MatrixXd& values);

}  // namespace chladni::mbs_export
