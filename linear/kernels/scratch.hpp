#pragma once

#include <memory>
#include <string>

#include "common/petsc.hpp"
#include "linear/kernels/growing_memory.hpp"

namespace chladni::linear {

/// A dense matrix with the rows of A and zeros, for as many columns as make up a large part of the
/// memory: it takes room where something is written only. In a folder each rank has a file for its
/// rows (`GrowingMemory`).
/// @param folder  for scratch files; empty: the matrix is in memory
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room for it.
petsc::Matrix large_dense(Mat A, PetscInt n_columns, const std::string& folder);

/// Room for numbers of this rank, all zero: in memory, or in a file in a folder.
/// @note   Collective.
/// @throws chladni::Error on all ranks when one has no room.
std::unique_ptr<GrowingMemory> room_for(double n_bytes, const std::string& folder, MPI_Comm comm);

/// Keeps the memory that a matrix refers to as long as the matrix lives.
void keep_with(Mat A, std::unique_ptr<GrowingMemory> memory);

}  // namespace chladni::linear
