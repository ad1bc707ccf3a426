#pragma once

#include "common/petsc.hpp"
#include "cyclic/harmonic_coordinates.hpp"

namespace chladni::cyclic {

enum class Symmetry { symmetric, none };

/// A copy of an AIJ matrix that one rank has whole.
SparseRows sparse_rows(Mat A);

/// @return AIJ; each rank of `comm`, which all have the whole of A, takes its share of the rows
/// @note   Collective on `comm`.
petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry, MPI_Comm comm = PETSC_COMM_SELF);

}  // namespace chladni::cyclic
