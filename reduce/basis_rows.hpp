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

/// The rows of Q_CB that belong to some DOFs.
/// @param dofs     global DOFs of K, the same list on every rank
/// @param rows_of  the partition that the basis belongs to
/// @return [n_dofs x (n_m + n_CB)], on every rank
/// @note   Collective.
Eigen::MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                           const std::vector<PetscInt>& dofs);

}  // namespace chladni::reduce
