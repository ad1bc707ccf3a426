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

}  // namespace chladni::linear
