#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::reduce {

/// Masters m and slaves s of a system. Each rank holds those that it owns, ascending.
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

/// The global DOF of a row of the block ss, on every rank.
/// @note   Collective.
PetscInt dof_of_slave(const DofPartition& dofs, PetscInt row);

/// The global DOFs of the rows of the block ss, on every rank.
/// @note   Collective.
std::vector<PetscInt> all_slaves(const DofPartition& dofs);

/// Copies the blocks of `A` by masters and slaves.
/// @note   Collective on the communicator of `A`.
Blocks split(Mat A, const DofPartition& dofs);

}  // namespace chladni::reduce
