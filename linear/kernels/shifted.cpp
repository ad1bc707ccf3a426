#include "linear/kernels/shifted.hpp"

namespace chladni::linear {

namespace {

bool is_sequential_aij(Mat A)
{
  PetscBool is = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), MATSEQAIJ, &is));
  return is == PETSC_TRUE;
}

/// Adds `factor` B to A where the pattern of A has that of B; false where it has not, and A is then
/// spoilt. PETSc inserts entry by entry.
bool add_within_pattern(Mat A, double factor, Mat B)
{
  PetscInt n = 0;
  const PetscInt *starts_A = nullptr, *columns_A = nullptr, *starts_B = nullptr,
                 *columns_B = nullptr;
  PetscBool has_A = PETSC_FALSE, has_B = PETSC_FALSE;
  PetscScalar* to = nullptr;
  const PetscScalar* from = nullptr;
  petsc::check(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_A, &columns_A, &has_A));
  petsc::check(MatGetRowIJ(B, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_B, &columns_B, &has_B));
  petsc::check(MatSeqAIJGetArray(A, &to));
  petsc::check(MatSeqAIJGetArrayRead(B, &from));
  bool is_within = has_A == PETSC_TRUE && has_B == PETSC_TRUE;
  for (PetscInt row = 0; row < n && is_within; ++row) {
    PetscInt at = starts_A[row];
    for (PetscInt k = starts_B[row]; k < starts_B[row + 1] && is_within; ++k) {
      while (at < starts_A[row + 1] && columns_A[at] < columns_B[k]) ++at;
      is_within = at < starts_A[row + 1] && columns_A[at] == columns_B[k];
      if (is_within) to[at] += factor * from[k];
    }
  }
  petsc::check(MatSeqAIJRestoreArrayRead(B, &from));
  petsc::check(MatSeqAIJRestoreArray(A, &to));
  petsc::check(MatRestoreRowIJ(B, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_B, &columns_B, &has_B));
  petsc::check(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts_A, &columns_A, &has_A));
  return is_within;
}

petsc::Matrix copy_of(Mat A)
{
  petsc::Matrix copy;
  petsc::check(MatDuplicate(A, MAT_COPY_VALUES, copy.put()));
  return copy;
}

/// A + factor B
petsc::Matrix sum(Mat A, double factor, Mat B)
{
  if (is_sequential_aij(A) && is_sequential_aij(B)) {
    petsc::Matrix C = copy_of(A);
    if (add_within_pattern(C, factor, B)) return C;
  }
  petsc::Matrix C = copy_of(A);
  petsc::check(MatAXPY(C, factor, B, DIFFERENT_NONZERO_PATTERN));
  return C;
}

}  // namespace

petsc::Matrix shifted(Mat K, Mat M, double sigma)
{
  petsc::Matrix A = sum(K, -sigma, M);
  petsc::check(MatSetOption(A, MAT_SPD, PETSC_FALSE));  // K_ss is marked definite, A is not
  petsc::check(MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE));
  return A;
}

}  // namespace chladni::linear
