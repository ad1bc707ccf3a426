#include "cyclic/sparse_rows.hpp"

namespace chladni::cyclic {

SparseRows sparse_rows(Mat A)
{
  PetscInt n_rows = 0, n_cols = 0, n = 0;
  PetscBool is_done = PETSC_FALSE;
  const PetscInt *start = nullptr, *columns = nullptr;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetSize(A, &n_rows, &n_cols));
  petsc::check(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &start, &columns, &is_done));
  if (!is_done) throw Error("a sector needs a matrix of type AIJ on one rank");
  petsc::check(MatSeqAIJGetArrayRead(A, &values));
  SparseRows copy =
      Eigen::Map<const SparseRows>(n_rows, n_cols, start[n_rows], start, columns, values);
  petsc::check(MatSeqAIJRestoreArrayRead(A, &values));
  petsc::check(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &start, &columns, &is_done));
  return copy;
}

petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry)
{
  petsc::Matrix matrix;
  petsc::check(MatCreate(PETSC_COMM_SELF, matrix.put()));
  const auto n_rows = static_cast<PetscInt>(A.rows()), n_cols = static_cast<PetscInt>(A.cols());
  petsc::check(MatSetSizes(matrix, n_rows, n_cols, n_rows, n_cols));
  petsc::check(MatSetType(matrix, MATSEQAIJ));
  petsc::check(
      MatSeqAIJSetPreallocationCSR(matrix, A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr()));
  if (symmetry == Symmetry::symmetric) {
    petsc::check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
    petsc::check(MatSetOption(matrix, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  }
  return matrix;
}

}  // namespace chladni::cyclic
