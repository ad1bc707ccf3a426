#pragma once

#include "common/petsc.hpp"

namespace chladni::reduce {

/// Masters m and slaves s of a system; each rank holds those that it owns, ascending.
struct DofPartition {
  petsc::IndexSet masters, slaves;
};

/// Blocks of a symmetric matrix in the order (m, s); ms is the transpose of sm.
struct Blocks {
  petsc::Matrix mm, ms, sm, ss;
};

/// Slaves are all DOFs of `K` that are not masters.
/// @param masters  global indices, each on the rank that owns it (in any order).
/// @param least    masters that there must be: 0 where modes alone are wanted
/// @note   Collective on the communicator of `K`.
/// @throws chladni::Error when there are fewer masters, or no slave, or a master is out of range or
///         double.
DofPartition partition(Mat K, IS masters, PetscInt least = 1);

/// The global DOF of a row of the blocks ss, on every rank.
/// @note   Collective.
PetscInt dof_of_slave(const DofPartition& dofs, PetscInt row);

/// @note   Collective on the communicator of `A`.
Blocks split(Mat A, const DofPartition& dofs);

}  // namespace chladni::reduce
