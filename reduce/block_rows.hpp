#pragma once

#include <span>
#include <vector>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/partition.hpp"

/// Dense matrices between two layouts: the rows of all DOFs, and the rows of masters and slaves.
namespace chladni::reduce {

/// Copies the rows of the slaves out of a dense X.
/// @param like  a matrix with the row layout of the slaves, such as K_ss
/// @return [n_s x columns of X] dense
petsc::Matrix slave_rows(Mat X, const DofPartition& dofs, Mat like);

/// Copies the rows of the masters out of a dense X.
/// @return [n_m x columns of X], on every rank
/// @note   Collective.
Eigen::MatrixXd master_rows(Mat X, const DofPartition& dofs);

/// Copies some rows of this rank and some columns out of a dense matrix.
/// @param like  a matrix with so many rows
petsc::Matrix block_of(const linear::LocalRows& X, const std::vector<PetscInt>& rows,
                       std::span<const int> columns, Mat like);

/// Writes X_m to the rows of the masters in X and X_s to those of the slaves.
void set_rows(Mat X, const DofPartition& dofs, const Eigen::MatrixXd& X_m, Mat X_s);

/// The columns of R and then the first k columns of X, as one dense matrix.
petsc::Matrix beside(Mat R, Mat X, PetscInt k);

}  // namespace chladni::reduce
