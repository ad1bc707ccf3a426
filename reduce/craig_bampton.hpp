#pragma once

#include <optional>
#include <span>
#include <vector>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/forms.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "reduce/static_condensation.hpp"

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

/// The columns of Q_CB with the rows of K. Refers to the basis.
class BasisColumns {
 public:
  /// @param rows_of  the partition that the basis belongs to
  /// @note   Collective.
  BasisColumns(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of);
  PetscInt size() const { return n_m_ + (Phi_ ? Phi_->n_cols() : 0); }
  /// Writes this rank's rows of a column.
  void write(PetscInt column, std::span<double> rows) const;

 private:
  linear::LocalRows Psi_;
  std::optional<linear::LocalRows> Phi_;
  PetscInt n_m_, first_master_;
  std::vector<PetscInt> masters_, slaves_;  ///< counted from the first row of this rank
};

/// The rows of Q_CB on this rank. Refers to the basis.
class OwnBasisRows {
 public:
  /// @param rows_of  the partition that the basis belongs to
  /// @note   Collective.
  OwnBasisRows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of);
  PetscInt n_columns() const { return Psi_.n_cols() + (Phi_ ? Phi_->n_cols() : 0); }
  /// True where this rank has the row of a DOF of K.
  bool has(PetscInt dof) const { return master(dof) || slave(dof); }
  /// @param dofs  of K, in any order
  /// @return [n_dofs x n_columns], zero for DOFs that this rank does not have
  Eigen::MatrixXd rows(const std::vector<PetscInt>& dofs) const;

 private:
  /// The places of DOFs among those of a set on this rank, in any order.
  class Places {
   public:
    explicit Places(IS set);
    std::optional<PetscInt> operator()(PetscInt dof) const;

   private:
    static constexpr PetscInt none = -1;
    PetscInt first_ = 0;
    std::vector<PetscInt> place_;
  };
  std::optional<PetscInt> master(PetscInt dof) const { return masters_(dof); }
  std::optional<PetscInt> slave(PetscInt dof) const { return slaves_(dof); }

  linear::LocalRows Psi_;
  std::optional<linear::LocalRows> Phi_;
  PetscInt first_master_;
  Places masters_, slaves_;
};

/// The rows of Q_CB that belong to some DOFs.
/// @param dofs     global DOFs of K, the same list on every rank
/// @param rows_of  the partition that the basis belongs to
/// @return [n_dofs x (n_m + n_CB)], on every rank
/// @note   Collective.
Eigen::MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                           const std::vector<PetscInt>& dofs);

/// Q_CB^T A Q_CB of a matrix, symmetric or not: of dampers, of Coriolis forces.
/// @param symmetry  of A; a symmetry saves half of the work
/// @return [n_m + n_CB squared], on every rank
/// @note   Collective.
Eigen::MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A,
                             linear::FormSymmetry symmetry = linear::FormSymmetry::none);

/// The same of several matrices with entries in some components of the nodes only, in less time:
/// the basis is read once, but the rows that the matrices need are copied.
/// @param forms  with the rows of K; their block size is the number of components
/// @return [n_m + n_CB squared] each, on every rank
/// @note   Collective.
std::vector<Eigen::MatrixXd> project_forms(const CraigBamptonBasis& Q_CB, const DofPartition& dofs,
                                           std::span<const linear::SparseForm> forms);

/// Q_CB^T V of a few dense columns V with the rows of K.
/// @return [n_m + n_CB x k], on every rank
/// @note   Collective.
Eigen::MatrixXd project_vectors(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, Mat V);

}  // namespace chladni::reduce
