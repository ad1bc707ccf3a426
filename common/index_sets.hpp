#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::petsc {

/// The global indices of a set that this rank holds.
inline std::vector<PetscInt> own_indices(IS set)
{
  PetscInt n = 0;
  const PetscInt* indices = nullptr;
  check(ISGetLocalSize(set, &n));
  check(ISGetIndices(set, &indices));
  std::vector<PetscInt> own(indices, indices + n);
  check(ISRestoreIndices(set, &indices));
  return own;
}

/// Those of rows of A, on the rank that owns them, counted from its first row.
inline std::vector<PetscInt> own_rows(IS rows, Mat A)
{
  PetscInt first = 0;
  check(MatGetOwnershipRange(A, &first, nullptr));
  std::vector<PetscInt> own = own_indices(rows);
  for (PetscInt& row : own) row -= first;
  return own;
}

/// How many indices of a set the ranks before this one hold.
/// @note   Collective on the communicator of the set.
inline PetscInt indices_before(IS set)
{
  PetscInt n = 0, before = 0;
  check(ISGetLocalSize(set, &n));
  MPI_Exscan(&n, &before, 1, MPIU_INT, MPI_SUM, communicator(set));
  return rank(communicator(set)) == 0 ? 0 : before;
}

}  // namespace chladni::petsc
