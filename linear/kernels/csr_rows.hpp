#pragma once

#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

inline constexpr PetscInt narrow_panel = 8;  ///< columns side by side: a cache line
inline constexpr PetscInt wide_panel = 16;

/// Rows first to last - 1 of this rank.
struct RowSpan {
  PetscInt first, last;
  PetscInt size() const { return last - first; }
};

/// The arrays of a sparse matrix by rows.
struct Csr {
  const PetscInt* starts;
  const PetscInt* columns;
  const PetscScalar* values;
  std::span<const PetscInt> row(PetscInt i) const
  {
    return {columns + starts[i], columns + starts[i + 1]};
  }
};

/// Y <- A panel in some rows, Y row by row like the panel, of narrow_panel or wide_panel columns.
/// @param n_alike  [rows of A] as `numbers_alike` gives it
void multiply_narrow(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                     double* Y);
void multiply_wide(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                   double* Y);

/// Y <- Y + A panel.
void add_narrow(const Csr& A, const RowSpan& rows, const double* panel, double* Y);
void add_wide(const Csr& A, const RowSpan& rows, const double* panel, double* Y);

/// Rows at which a square matrix may be cut, so that no entry joins those before with the others
/// and each piece has at least a sixteenth of the n rows.
std::vector<PetscInt> cuts(const Csr& A, PetscInt n);

/// How many of the n rows have the same columns from each one on, up to three: so many are
/// multiplied at a time.
std::vector<char> numbers_alike(const Csr& A, PetscInt n);

}  // namespace chladni::linear
