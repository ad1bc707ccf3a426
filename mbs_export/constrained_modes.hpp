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

}  // namespace chladni::mbs_export
