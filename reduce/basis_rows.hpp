#pragma once

#include <vector>

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// The rows of Q_CB that belong to some DOFs.
/// @param dofs     global DOFs of K, the same list on every rank
/// @param rows_of  the partition that the basis belongs to
/// @return [n_dofs x (n_m + n_CB)], on every rank
/// @note   Collective.
Eigen::MatrixXd basis_rows(const CraigBamptonBasis& Q_CB, const DofPartition& rows_of,
                           const std::vector<PetscInt>& dofs);

}  // namespace chladni::reduce
