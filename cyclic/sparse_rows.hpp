#pragma once

#include "common/petsc.hpp"
#include "cyclic/harmonic_coordinates.hpp"

namespace chladni::cyclic {

enum class Symmetry { symmetric, none };

/// A copy of an AIJ matrix that one rank has whole.
SparseRows sparse_rows(Mat A);

/// @return AIJ of this rank alone
petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry);

}  // namespace chladni::cyclic
