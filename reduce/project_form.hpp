#pragma once

#include <span>
#include <vector>

#include "linear/kernels/parted_form.hpp"
#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

/// Q_CB^T A Q_CB of a matrix, symmetric or not: of dampers, of Coriolis forces.
/// @param symmetry  of A; a symmetry saves half of the work
/// @return [n_m + n_CB squared], on every rank
/// @note   Collective.
Eigen::MatrixXd project_form(const CraigBamptonBasis& Q_CB, const Blocks& A,
                             linear::FormSymmetry symmetry = linear::FormSymmetry::none);

/// A matrix whose projection is wanted.
struct FormBlocks {
  Blocks A;
  linear::FormSymmetry symmetry;
};

/// The projections of several matrices, in one pass over the basis.
/// @param K_ss  which Q_CB was made with: bending and motion in the plane may be decoupled in it
/// @note   Collective.
std::vector<Eigen::MatrixXd> project_forms(const CraigBamptonBasis& Q_CB, Mat K_ss,
                                           std::span<const FormBlocks> forms);

/// Q_CB^T V of a few dense columns V with the rows of K.
/// @return [n_m + n_CB x k], on every rank
/// @note   Collective.
Eigen::MatrixXd project_vectors(const CraigBamptonBasis& Q_CB, const DofPartition& dofs, Mat V);

}  // namespace chladni::reduce
