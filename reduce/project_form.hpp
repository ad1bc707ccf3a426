#pragma once

#include <span>
#include <vector>

#include "linear/kernels/component_forms.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

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
