#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

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

}  // namespace chladni::reduce
