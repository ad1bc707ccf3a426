#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "linear/dense/eigenmodes.hpp"
#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/free_modes.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// The free modes under the constraint 0 = Q_dd q_d + Q_di q_i on n_c held displacements: q = Q_c
/// q_i with Q_c = [-Q_dd^-1 Q_di; I], rows in the order of the free modes.
struct ModeShift {
  Eigen::MatrixXd Q_c;  ///< [n_modes x n_modes - n_c]
  Eigen::MatrixXd K_c;  ///< Q_c^T diag(omega^2) Q_c, rad^2/s^2
  Eigen::MatrixXd M_c;  ///< Q_c^T Q_c
  /// [n_modes - n_c x n_free_rigid] remaining rigid motions, M_c-orthonormal
  Eigen::MatrixXd R_c;
  std::vector<int> dependent;  ///< [n_c] the modes d, ascending
  /// condition number of Q_dd; 1 if nothing is held
  double condition_Q_dd;
  /// Condition number of Q_dd with rows of unit length: the mutual dependence of the held
  /// displacements, whatever their units. 1 if nothing is held.
  double condition_directions;
};

/// Mode shifting. Dependent modes are the rigid ones as far as they are independent at the held
/// DOFs; further ones are chosen by pivoting among the elastic modes, with a preference for low
/// frequencies.
/// @throws chladni::Error naming the DOFs when no choice has cond(Q_dd) below 1e6.
ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held);

/// Orthonormal combinations of rigid motions that leave the held DOFs at rest, [n_rigid x k].
/// @param held_displacements  [n_c x n_rigid] of each motion
Eigen::MatrixXd unheld_combinations(const Eigen::MatrixXd& held_displacements);

/// Mode shifting with given dependent modes.
/// @param dependent  [n_c] indices of free modes, ascending
/// @throws chladni::Error naming the DOFs when cond(Q_dd) > 1e6 in rows of unit length, and when
///         very stiff modes leave the lowest eigenvalue to rounding.
ModeShift shift_modes(const FreeModes& modes, const HeldDofs& held,
                      const std::vector<int>& dependent);

/// Modes of the held body: (K_c - omega^2 M_c) x = 0, X^T M_c X = I.
struct ConstrainedModes {
  Eigen::VectorXd omega;  ///< [n], rad/s, ascending; the first n_rigid are exactly zero
  Eigen::MatrixXd X;      ///< [n_i x n] in the coordinates q_i of the mode shifting
  int n_rigid;            ///< rigid-body motions that the held displacements leave free
};

/// The modes of the held body.
ConstrainedModes constrained_modes(const ModeShift& shift);

/// The indices of the kept modes and of all others, each ascending.
struct ModeSelection {
  std::vector<int> kept;
  std::vector<int> neglected;
  int n_partners;  ///< modes kept in addition, so that modes of one frequency stay together
};

/// The modes first .. end - 1, which have one frequency.
struct ModeCluster {
  int first;
  int end;
};

/// Divides the modes into clusters whose neighbours are within 1e-4 in frequency (the two modes of
/// a disc's nodal diameters; all rigid modes).
/// @param omega  [n], rad/s, ascending
std::vector<ModeCluster> mode_clusters(const Eigen::VectorXd& omega);

/// Selects modes by number, frequency or list; rigid modes count as modes. If one mode of a cluster
/// is selected, so are the others. A tolerance needs `select_by_tolerance` instead.
/// @param omega  [n], rad/s, ascending
/// @throws chladni::Error for more than one criterion, a mode that does not exist, or no mode left.
ModeSelection select_modes(const Eigen::VectorXd& omega, const KeptModes& keep);

/// A reduced system under its supports: free modes, and modes of the held body.
struct HeldBody {
  FreeModes free;
  HeldDofs held;
  Eigen::VectorXd omega = {};  ///< [n], rad/s, ascending; the first n_rigid are exactly zero
  int n_rigid = 0;             ///< rigid-body motions that the support leaves
  double condition_Q_dd = 1.0, condition_directions = 1.0;  ///< as ModeShift; 1 without one
  Eigen::MatrixXd T = {};  ///< [n_FE x n] modes in the coordinates of the reduced system
  Eigen::MatrixXd U = {};  ///< [6 n_nodes x n] motion of the attachment nodes in the modes T
};

/// Computes the modes of a reduced system under its supports, by mode shifting. Where no choice of
/// dependent modes holds the displacements apart, as of the nodes of a whole edge, whose rotations
/// about the normal of a shell have hardly any stiffness, held masters are left out of the system.
/// @param fixed  as BodyOptions::fixed
/// @throws chladni::Error as `orthogonalize`, `held_dofs` and `shift_modes`.
HeldBody held_body(const ReducedSystem& reduced, const std::vector<std::string>& fixed);

/// Elastic modes of a reduced system under the supports of a scene.
struct HeldModeShapes {
  Eigen::VectorXd omega;  ///< [k] rad/s, ascending, positive
  Eigen::MatrixXd X;      ///< [n_FE x k] in the reduced coordinates, X^T M_r X = I
  int n_rigid;            ///< number of rigid-body motions that the support leaves
  int n_free_rigid;       ///< number of rigid-body motions without a support
};

/// The elastic modes of a reduced system under a support.
/// @param fixed   as BodyOptions::fixed
/// @param wanted  range of the modes; all by default
/// @throws chladni::Error as `orthogonalize`, `held_dofs` and `shift_modes`.
HeldModeShapes held_mode_shapes(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                                const linear::LowestModes& wanted = {});

/// FreeModes::rigid_residual of the body without a support, to a few per cent.
/// @throws chladni::Error as `rigid_modes`.
double rigid_residual(const ReducedSystem& reduced);

}  // namespace chladni::mbs_export

/// Drilling rotations: rotations of attachment nodes about the normal of a shell, which elements
/// resist by a numerical stiffness alone.

namespace chladni::mbs_export {

/// True if this component of an attachment node is a drilling rotation or contains one.
bool is_drilling(const ReducedSystem& reduced, int node, int component);

/// Checks that a loaded component is no drilling rotation.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling_load(const ReducedSystem& reduced, int node, int component);

/// Checks that the body is held without the drilling rotations among the held DOFs.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling_support(const ReducedSystem& reduced, const HeldDofs& held);

}  // namespace chladni::mbs_export
