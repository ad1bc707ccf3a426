#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

enum class ModeKind { rigid, constrained, interface };

/// A contact ring of the body: attachment nodes on a circle about the z axis, ordered by angle, and
/// what each mode does there. Slopes come from the nodal rotations of the shear-flexible shell:
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
  int n_constrained_modes = 0;  ///< modes of the held body that there were to keep
  int n_partners = 0;  ///< kept beyond the choice, so as not to part modes of one frequency
  int n_interface_dropped = 0;  ///< interface modes that depended on others
  int n_massless = 0;           ///< reduced coordinates without mass, which the modes cannot carry
  double rigid_residual = 0.0;  ///< energy of the rigid modes over the first elastic omega^2
  /// Of Q_dd with rows of unit length, which takes their units out; a file may not know it.
  std::optional<double> condition_directions = {};
};

/// One step of a selection by tolerance, and what the basis is after it.
struct SelectionStep {
  std::string added;  ///< "modes 7, 8" or "interface modes track.z, 3 diameters, at 1500 Hz"
  int n_modes;        ///< constrained and rigid modes
  int n_interface;    ///< interface modes
  double error;       ///< largest relative error of the frequency responses

  int size() const { return n_modes + n_interface; }
};

/// Size against error: what each size buys, without and with interface modes.
struct SelectionTable {
  double error;  ///< the tolerance
  /// Of the reduced system against the FE model, which comes on top of the errors of the steps;
  /// nothing where these are all that is known.
  std::optional<double> of_reduction = {};
  double Omega_max;                ///< end of the range, rad/s
  std::vector<std::string> loads;  ///< loaded attachment DOFs, "track.z" for all nodes of a set
  std::vector<SelectionStep> modes_only;
  std::vector<SelectionStep> with_interface_modes;
};

/// A body of n_modes modal coordinates q with mass matrix I and stiffness diag(omega^2):
/// q'' + C q' + diag(omega^2) q = (mode shapes)^T forces. It is all that a squeal study needs.
struct ModalBody {
  std::string title;
  std::vector<ModeKind> kinds;  ///< [n_modes]
  Eigen::VectorXd omega;        ///< [n_modes], rad/s, ascending
  /// [n_modes x n_modes], 1/s, or [0 x 0]; with the viscous equivalent of `H` (body_damping.hpp)
  Eigen::MatrixXd C;
  /// [n_modes x n_modes] structural damping, diag(omega^2) + i H at a harmonic motion, 1/s^2, or
  /// [0 x 0]
  Eigen::MatrixXd H = {};
  std::vector<AttachmentNode> attachment_nodes;
  std::vector<AttachmentSet> sets;
  std::vector<std::string> fixed;    ///< what the scene holds, e.g. "hub", "hub.z"
  Eigen::MatrixXd attachment_modes;  ///< [6 n_nodes x n_modes] u and theta of each node
  std::vector<ContactRing> rings;
  Picture picture;                   ///< transformation is [3 n x n_modes] here
  double mass;                       ///< kg
  Eigen::Vector3d centre_of_mass;    ///< m
  Eigen::Matrix3d inertia;           ///< about the centre of mass, kg m^2
  Eigen::VectorXd free_frequencies;  ///< of the free reduced body, rad/s; see n_rigid
  int n_rigid;                       ///< how many of them are rigid-body motions
  double condition_Q_dd;             ///< of the mode shifting (1 when nothing is held)
  int n_free_rigid = 0;  ///< rigid-body motions that `fixed` leaves free: 0 for a held body
  Preparation preparation = {};
  std::vector<ResultantModes> resultants = {};       ///< in the modes, N or the like per unit of q
  std::optional<MassIntegrals> mass_integrals = {};  ///< phi_i: mode shapes, m per unit of q
  /// Where the reduced system has it for `fixed`; 1 or 1/m per unit of the factor of each load.
  std::optional<Stiffening> stiffening = {};
  std::optional<SelectionTable> selection = {};          ///< when a tolerance chose the modes
  std::optional<SectorHarmonics> sector_harmonics = {};  ///< of a body of equal sectors
  Certificate certificate = {};  ///< of the reduced system; for the body where it is `fixed` alike
  Provenance provenance;

  Eigen::Index n_modes() const { return omega.size(); }
};

/// phi^T H phi / phi^T K phi of each mode, 1; zero of modes without stiffness, empty without H.
Eigen::VectorXd loss_factors(const ModalBody& body);

/// @throws chladni::Error naming the rings that exist.
const ContactRing& find_ring(const ModalBody& body, const std::string& name);

}  // namespace chladni::mbs_export
