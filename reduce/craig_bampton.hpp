#pragma once

#include <optional>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/constraint_modes.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "reduce/partition.hpp"

namespace chladni::reduce {

/// Q_CB = [I 0; Psi Phi], never formed. Without modes it is Guyan's Q_G = [I; Psi].
struct CraigBamptonBasis {
  petsc::Matrix Psi;                         ///< [n_s x n_m] dense
  std::optional<FixedInterfaceModes> modes;  ///< Phi [n_s x n_CB] dense

  PetscInt n_modes() const { return modes ? static_cast<PetscInt>(modes->omega.size()) : 0; }
};

/// Static condensation to the masters.
struct GuyanStiffness {
  Eigen::MatrixXd K;  ///< K_G [n_m x n_m]
  Eigen::MatrixXd R;  ///< [n_m x r] independent motions of the masters with K_G R = 0
};

/// The reduced system in (u_m, q), the same on every rank; masters in the order of the partition.
struct ReducedModel {
  Eigen::MatrixXd K, M;  ///< [n_m + n_CB squared]
  PetscInt n_masters;
  std::vector<double> omega;  ///< [n_CB] rad/s of the fixed-interface modes
  Eigen::MatrixXd R = {};     ///< [n_m x r] of the motions that K does not resist, at the masters
};

/// K_r = diag(K_mm + K_ms Psi, diag(omega^2)),
/// M_r = [M_G, P^T; P, I], M_G = M_mm + M_ms Psi + Psi^T (M_sm + M_ss Psi),
/// P = Phi^T (M_ss Psi + M_sm): known blocks are not multiplied out; symmetric by construction.
/// Source: Craig and Bampton, AIAA J. 6 (1968) 1313; Guyan, AIAA J. 3 (1965) 380.
/// @note   Collective.
ReducedModel project(const CraigBamptonBasis& Q_CB, const Blocks& K, const Blocks& M);

/// Q_CB^T A Q_CB of any matrix, symmetric or not: of dampers, of Coriolis forces.
/// @return [n_m + n_CB squared], on every rank
/// @note   Collective.
Eigen::MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A);

/// Q_CB^T V of a few dense columns with the rows of K.
/// @return [n_m + n_CB x k], on every rank
/// @note   Collective.
Eigen::MatrixXd project_vectors(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, Mat V);

/// Rows of Q_CB.
/// @param dofs     global DOFs of K, the same list on every rank.
/// @param rows_of  the partition that the basis belongs to.
/// @return [n_dofs x (n_m + n_CB)], on every rank.
/// @note   Collective.
Eigen::MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                           const std::vector<PetscInt>& dofs);

}  // namespace chladni::reduce
