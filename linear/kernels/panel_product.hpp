#pragma once

#include <petscsystypes.h>

#include <span>

namespace chladni::linear {

/// Columns of a panel: a cache line, or two.
constexpr PetscInt narrow_panel = 8, wide_panel = 16;

/// The arrays of a sparse matrix in CSR form.
struct CsrArrays {
  const PetscInt* starts;
  const PetscInt* columns;
  const PetscScalar* values;
};

/// Y <- Y + A X in some rows of A; X and Y are panels, row by row.
/// @param rows  ascending
void add_narrow_product(const CsrArrays& A, std::span<const PetscInt> rows, const double* X,
                        double* Y);
void add_wide_product(const CsrArrays& A, std::span<const PetscInt> rows, const double* X,
                      double* Y);

}  // namespace chladni::linear
