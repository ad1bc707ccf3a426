#pragma once

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

/// A + B, where B has as many rows as A.
SmallMatrix sum(const SmallMatrix& A, const SmallMatrix& B);

/// A B
SmallMatrix product(const SmallMatrix& A, const SmallMatrix& B);

SmallMatrix transposed(const SmallMatrix& A);

/// Rows first .. last - 1 of A.
SmallMatrix row_range(const SmallMatrix& A, PetscInt first, PetscInt last);

/// Columns first .. last - 1 of A.
SmallMatrix column_range(const SmallMatrix& A, PetscInt first, PetscInt last);

/// These rows of A.
SmallMatrix chosen_rows(const SmallMatrix& A, const std::vector<PetscInt>& rows);

/// These columns of A.
SmallMatrix chosen_columns(const SmallMatrix& A, const std::vector<PetscInt>& columns);

/// A above B.
SmallMatrix stacked(const SmallMatrix& A, const SmallMatrix& B);

/// Y <- beta Y + alpha X S for column-major local rows X [n_local x S.n_rows], Y.
void add_product(double alpha, const double* X, PetscInt n_local, const SmallMatrix& S, double beta,
                 double* Y);

}  // namespace chladni::linear
