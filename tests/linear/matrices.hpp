#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "chain.hpp"

namespace chladni::linear::testing {

/// Columns and values of one row.
using Row = std::vector<std::pair<PetscInt, double>>;

/// Symmetric matrix of n rows with up to `width` entries in a row, by place.
inline petsc::Matrix matrix(PetscInt n, PetscInt width, const std::function<Row(PetscInt)>& row)
{
  petsc::Matrix A;
  petsc::check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, width, nullptr,
                            width, nullptr, A.put()));
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    for (const auto& [j, value] : row(i)) petsc::check(MatSetValue(A, i, j, value, INSERT_VALUES));
  finish(A);
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  return A;
}

inline petsc::Matrix diagonal(PetscInt n, const std::function<double(PetscInt)>& value)
{
  return matrix(n, 1, [&](PetscInt i) { return Row{{i, value(i)}}; });
}

}  // namespace chladni::linear::testing
