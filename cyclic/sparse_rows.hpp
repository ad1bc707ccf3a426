#pragma once

#include "common/petsc.hpp"
#include "cyclic/harmonic_coordinates.hpp"

namespace chladni::cyclic {

enum class Symmetry { symmetric, none };

/// A copy of an AIJ matrix that lies on one rank.
SparseRows sparse_rows(Mat A);

/// A matrix that each rank of `comm` has whole, as AIJ with the rows distributed over `comm`.
/// @note   Collective on `comm`.
petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry, MPI_Comm comm = PETSC_COMM_SELF);

}  // namespace chladni::cyclic
