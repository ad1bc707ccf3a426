#include "linear/kernels/small_matrices.hpp"

#include <petscblaslapack.h>

#include <algorithm>

namespace chladni::linear {

SmallMatrix sum(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C = A;
  for (std::size_t i = 0; i < C.values.size(); ++i) C.values[i] += B.values[i];
  return C;
}

SmallMatrix product(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C(A.n_rows, B.n_cols);
  add_product(1.0, A.values.data(), A.n_rows, B, 0.0, C.values.data());
  return C;
}

SmallMatrix transposed(const SmallMatrix& A)
{
  SmallMatrix A_T(A.n_cols, A.n_rows);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) A_T(j, i) = A(i, j);
  }
  return A_T;
}

SmallMatrix row_range(const SmallMatrix& A, PetscInt first, PetscInt last)
{
  SmallMatrix B(last - first, A.n_cols);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = first; i < last; ++i) B(i - first, j) = A(i, j);
  }
  return B;
}

SmallMatrix column_range(const SmallMatrix& A, PetscInt first, PetscInt last)
{
  SmallMatrix B(A.n_rows, last - first);
  std::copy_n(A.values.begin() + std::size_t(first) * A.n_rows, B.values.size(), B.values.begin());
  return B;
}

SmallMatrix chosen_rows(const SmallMatrix& A, const std::vector<PetscInt>& rows)
{
  SmallMatrix B(static_cast<PetscInt>(rows.size()), A.n_cols);
  for (PetscInt j = 0; j < B.n_cols; ++j) {
    for (PetscInt i = 0; i < B.n_rows; ++i) B(i, j) = A(rows[i], j);
  }
  return B;
}

SmallMatrix chosen_columns(const SmallMatrix& A, const std::vector<PetscInt>& columns)
{
  SmallMatrix B(A.n_rows, static_cast<PetscInt>(columns.size()));
  for (PetscInt j = 0; j < B.n_cols; ++j) {
    for (PetscInt i = 0; i < B.n_rows; ++i) B(i, j) = A(i, columns[j]);
  }
  return B;
}

SmallMatrix stacked(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C(A.n_rows + B.n_rows, B.n_cols);
  for (PetscInt j = 0; j < B.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) C(i, j) = A(i, j);
    for (PetscInt i = 0; i < B.n_rows; ++i) C(A.n_rows + i, j) = B(i, j);
  }
  return C;
}

void add_product(double alpha, const double* X, PetscInt n_local, const SmallMatrix& S, double beta,
                 double* Y)
{
  const PetscBLASInt m = n_local;
  const PetscBLASInt n = S.n_cols;
  const PetscBLASInt k = S.n_rows;
  if (m == 0 || n == 0 || k == 0) return;
  BLASgemm_("N", "N", &m, &n, &k, &alpha, X, &m, S.values.data(), &k, &beta, Y, &m);
}

}  // namespace chladni::linear
