#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"

namespace chladni::reduce {

/// Masters m and slaves s of a system. Each rank holds those that it owns: masters ascending,
/// slaves ascending or in the order of `order_slaves`.
struct DofPartition {
  petsc::IndexSet masters, slaves;
};

/// The blocks of a symmetric matrix in the order (m, s); ms is the transpose of sm.
struct Blocks {
  petsc::Matrix mm, ms, sm, ss;
};

/// Divides the DOFs of `K`: all that are not masters are slaves.
/// @param masters  global indices, each on the rank that owns it, in any order
/// @param least    required number of masters; 0 where the modes alone are wanted
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when there are fewer masters, or no slave, or a master is out of range or
///         given twice.
DofPartition partition(Mat K, IS masters, PetscInt least = 1);

/// Orders the slaves of each rank as the work on them likes it: those that neither matrix couples
/// with others one after the other (bending and motion in the plane of a flat plate), and each of
/// these parts in the order of its elimination, in which what a row is multiplied with is near.
/// @return the order of elimination of the block ss of K, as linear::keep_order takes it
/// @note   Collective.
/// @throws chladni::Error as linear::elimination_order.
std::vector<int> order_slaves(DofPartition& dofs, Mat K, Mat M);

/// The global DOF of a row of the block ss, on every rank.
/// @note   Collective.
PetscInt dof_of_slave(const DofPartition& dofs, PetscInt row);

/// The global DOFs of the rows of the block ss, on every rank.
/// @note   Collective.
std::vector<PetscInt> all_slaves(const DofPartition& dofs);

/// Copies the blocks of `A` by masters and slaves.
/// @param scratch  folder for files that hold the block ss; empty: it is in memory
/// @note   Collective on the communicator of `A`.
/// @throws chladni::Error on all ranks when one has no room for them.
Blocks split(Mat A, const DofPartition& dofs, const std::string& scratch = {});

}  // namespace chladni::reduce

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
