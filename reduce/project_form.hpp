#pragma once

#include "linear/kernels/parted_form.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// Q_CB^T A Q_CB of a matrix, symmetric or not: of dampers, of Coriolis forces.
/// @param symmetry  of A; a symmetry saves half of the work
/// @return [n_m + n_CB squared], on every rank
/// @note   Collective.
Eigen::MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A,
                             linear::FormSymmetry symmetry = linear::FormSymmetry::none);

/// Q_CB^T V of a few dense columns V with the rows of K.
/// @return [n_m + n_CB x k], on every rank
/// @note   Collective.
Eigen::MatrixXd project_vectors(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, Mat V);

}  // namespace chladni::reduce
