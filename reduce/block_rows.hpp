#pragma once

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/partition.hpp"

/// Dense matrices in the rows of all DOFs, against those in the rows of masters and slaves.
namespace chladni::reduce {

/// The rows of a dense X at the slaves.
/// @param like  with the rows of the slaves, as K_ss
petsc::Matrix slave_rows(Mat X, const DofPartition& dofs, Mat like);

/// The rows of a dense X at the masters, on every rank.
/// @note   Collective.
Eigen::MatrixXd master_rows(Mat X, const DofPartition& dofs);

/// Writes X_m and X_s to the rows of X.
void set_rows(Mat X, const DofPartition& dofs, const Eigen::MatrixXd& X_m, Mat X_s);

/// [R, X] of the first k columns of X.
petsc::Matrix beside(Mat R, Mat X, PetscInt k);

}  // namespace chladni::reduce
