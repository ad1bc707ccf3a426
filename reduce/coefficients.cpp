#include "reduce/coefficients.hpp"

namespace chladni::reduce {

SmallMatrix coefficient_sum(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C = A;
  for (std::size_t i = 0; i < C.values.size(); ++i) C.values[i] += B.values[i];
  return C;
}

SmallMatrix row_range(const SmallMatrix& A, PetscInt first, PetscInt last)
{
  SmallMatrix B(last - first, A.n_cols);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = first; i < last; ++i) B(i - first, j) = A(i, j);
  }
  return B;
}

SmallMatrix stacked(const SmallMatrix& A, const SmallMatrix& B)
{
  SmallMatrix C(A.n_rows + B.n_rows, A.n_cols);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) C(i, j) = A(i, j);
    for (PetscInt i = 0; i < B.n_rows; ++i) C(A.n_rows + i, j) = B(i, j);
  }
  return C;
}

}  // namespace chladni::reduce
