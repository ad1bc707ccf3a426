#pragma once

#include <optional>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/constraint_modes.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "reduce/guyan_stiffness.hpp"

namespace chladni::reduce {

/// Q_CB = [I 0; Psi Phi], kept as its blocks. Without modes it is Guyan's Q_G = [I; Psi].
struct CraigBamptonBasis {
  petsc::Matrix Psi;                         ///< [n_s x n_m] dense
  std::optional<FixedInterfaceModes> modes;  ///< Phi [n_s x n_CB] dense

  PetscInt n_modes() const { return modes ? static_cast<PetscInt>(modes->omega.size()) : 0; }
};

/// The reduced system in (u_m, q), the same on every rank. Masters are in the order of the
/// partition.
struct ReducedModel {
  Eigen::MatrixXd K, M;  ///< [n_m + n_CB squared] K_r, M_r
  PetscInt n_masters;
  std::vector<double> omega;  ///< [n_CB] rad/s of the fixed-interface modes
  Eigen::MatrixXd R = {};     ///< [n_m x r] zero-energy motions of K at the masters
};

/// Projects K and M on the basis: K_r = diag(K_mm + K_ms Psi, diag(omega^2)),
/// M_r = [M_G, P^T; P, I] with M_G = M_mm + M_ms Psi + Psi^T (M_sm + M_ss Psi) and
/// P = Phi^T (M_ss Psi + M_sm). Blocks that are known are not computed; K_r and M_r are exactly
/// symmetric.
/// @note   Collective.
/// Source: Craig and Bampton, AIAA J. 6 (1968) 1313; Guyan, AIAA J. 3 (1965) 380.
ReducedModel project(const CraigBamptonBasis& Q_CB, const Blocks& K, const Blocks& M);

/// M_G = M_mm + M_ms Psi + Psi^T (M_sm + M_ss Psi), symmetric to the last bit.
/// @note   Collective.
Eigen::MatrixXd guyan_mass(Mat Psi, const Blocks& M);

/// P = Phi^T (M_ss Psi + M_sm), [columns of Phi x n_m].
/// @note   Collective.
Eigen::MatrixXd inertial_coupling(Mat Phi, Mat Psi, const Blocks& M);

/// Joins the parts of a reduced model: K_r = diag(K_G, diag(omega^2)), M_r = [M_G, P^T; P, I].
/// @param P  [at least n_CB x n_m] rows of the modes of `omega` first
ReducedModel join(const GuyanStiffness& K_G, const Eigen::MatrixXd& M_G, const Eigen::MatrixXd& P,
                  std::vector<double> omega);

}  // namespace chladni::reduce
