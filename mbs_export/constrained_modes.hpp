#pragma once

#include <Eigen/Core>
#include <vector>

#include "mbs_export/body_options.hpp"
#include "mbs_export/mode_shift.hpp"

namespace chladni::mbs_export {

/// Modes of the held body: (K_c - omega^2 M_c) x = 0, X^T M_c X = I.
struct ConstrainedModes {
  Eigen::VectorXd omega;  ///< [n], rad/s, ascending; the first n_rigid are exactly zero
  Eigen::MatrixXd X;      ///< [n_i x n] in the coordinates q_i of the mode shifting
  int n_rigid;            ///< rigid-body motions that the held displacements leave free
};

ConstrainedModes constrained_modes(const ModeShift& shift);

/// Indices of the modes kept and of all others, each ascending.
struct ModeSelection {
  std::vector<int> kept;
  std::vector<int> neglected;
  int n_partners;  ///< kept beyond the choice, because a cut would part modes of one frequency
};

/// Modes first .. end - 1.
struct ModeCluster {
  int first;
  int end;
};

/// The modes in clusters of one frequency: neighbours within 1e-4 (the two modes of a disc's nodal
/// diameters; all rigid modes).
/// @param omega  [n], rad/s, ascending
std::vector<ModeCluster> mode_clusters(const Eigen::VectorXd& omega);

/// Applies the scene's choice; rigid modes count as modes. A choice of one mode of a cluster is
/// extended to its partners. A tolerance is not for here but for `select_by_tolerance`.
/// @throws chladni::Error for more than one criterion, a mode that does not exist, or no mode left.
ModeSelection select_modes(const Eigen::VectorXd& omega, const KeptModes& keep);

}  // namespace chladni::mbs_export
