#pragma once

#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// Rows that a matrix A does not couple with others, and the columns that are not zero in these
/// rows.
struct FormPart {
  std::vector<PetscInt> rows;                  ///< of this rank, counted from its first, ascending
  std::vector<std::vector<PetscInt>> columns;  ///< of each X, the same on every rank
};

/// The parts whose sum is the form X^T A X. Rows without an entry of A are in none. Sets of rows
/// with the same columns are one part, so that the columns are read once.
/// @param X  dense, with the rows of A
/// @return empty if all rows form one part
/// @note   Collective.
std::vector<FormPart> form_parts(Mat A, std::span<const Mat> X);

/// The submatrix of A with the rows and columns of a part.
/// @note   Collective.
petsc::Matrix matrix_of(const FormPart& part, Mat A);

}  // namespace chladni::linear
