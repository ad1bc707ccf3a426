#pragma once

#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Rows that a matrix A does not couple with others, and the columns that are not zero there.
struct FormPart {
  std::vector<PetscInt> rows;                  ///< of this rank, counted from its first, ascending
  std::vector<std::vector<PetscInt>> columns;  ///< of each X, the same on every rank
};

/// The parts of the form X^T A X, whose sum it is; rows in which A has no entry are in none. Sets
/// of rows with the same columns are one part, so that these are read once.
/// @param X  dense, with the rows of A
/// @return empty where all rows belong together
/// @note   Collective.
std::vector<FormPart> form_parts(Mat A, std::span<const Mat> X);

/// A between the rows of a part.
/// @note   Collective.
petsc::Matrix matrix_of(const FormPart& part, Mat A);

}  // namespace chladni::linear
