#pragma once

#include <optional>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/constraint_modes.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "reduce/guyan_stiffness.hpp"

namespace chladni::reduce {

/// Q_CB = [I 0; Psi Phi], never formed. Without modes it is Guyan's Q_G = [I; Psi].
struct CraigBamptonBasis {
  petsc::Matrix Psi;                         ///< [n_s x n_m] dense
  std::optional<FixedInterfaceModes> modes;  ///< Phi [n_s x n_CB] dense

  PetscInt n_modes() const { return modes ? static_cast<PetscInt>(modes->omega.size()) : 0; }
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

/// M_G = M_mm + M_ms Psi + Psi^T (M_sm + M_ss Psi), symmetric to the last bit.
/// @note   Collective.
Eigen::MatrixXd guyan_mass(Mat Psi, const Blocks& M);

/// P = Phi^T (M_ss Psi + M_sm), [columns of Phi x n_m].
/// @note   Collective.
Eigen::MatrixXd inertial_coupling(Mat Phi, Mat Psi, const Blocks& M);

/// K_r = diag(K_G, diag(omega^2)), M_r = [M_G, P^T; P, I].
/// @param P  rows of all modes of `omega`, or more
ReducedModel join(const GuyanStiffness& K_G, const Eigen::MatrixXd& M_G, const Eigen::MatrixXd& P,
                  std::vector<double> omega);

}  // namespace chladni::reduce
