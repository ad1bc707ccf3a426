#pragma once

#include <string>

#include "common/petsc.hpp"

namespace chladni::linear {

/// A dense matrix with the rows of A and values that are not set, for as many columns as make up a
/// large part of the memory. In a folder each rank has a file for its rows (`GrowingMemory`).
/// @param folder  for scratch files; empty: the matrix is in memory, as by `uninitialized_dense`
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room for it.
petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder);

/// A sparse matrix whose arrays are moved into a file of each rank, where they take no memory while
/// nobody multiplies by it.
/// @param A       AIJ; any other type comes back as it is
/// @param folder  for scratch files; empty: A comes back as it is
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room for it.
petsc::Matrix moved_to_scratch(petsc::Matrix A, const std::string& folder);

}  // namespace chladni::linear
