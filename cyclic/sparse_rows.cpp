#include "cyclic/sparse_rows.hpp"

#include <vector>

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

petsc::Matrix as_matrix(const SparseRows& A, Symmetry symmetry, MPI_Comm comm)
{
  petsc::Matrix matrix;
  const auto n_rows = static_cast<PetscInt>(A.rows()), n_cols = static_cast<PetscInt>(A.cols());
  PetscInt n_own = PETSC_DECIDE, n_total = n_rows, first = 0;
  petsc::check(PetscSplitOwnership(comm, &n_own, &n_total));
  MPI_Exscan(&n_own, &first, 1, MPIU_INT, MPI_SUM, comm);
  if (petsc::rank(comm) == 0) first = 0;
  petsc::check(MatCreate(comm, matrix.put()));
  petsc::check(MatSetSizes(matrix, n_own, n_rows == n_cols ? n_own : PETSC_DECIDE, n_rows, n_cols));
  petsc::check(MatSetType(matrix, MATAIJ));
  std::vector<PetscInt> starts(A.outerIndexPtr() + first, A.outerIndexPtr() + first + n_own + 1);
  const PetscInt before = starts.front();
  for (PetscInt& start : starts) start -= before;
  const PetscInt* columns = A.innerIndexPtr() + before;
  const double* values = A.valuePtr() + before;
  petsc::check(MatSeqAIJSetPreallocationCSR(matrix, starts.data(), columns, values));
  petsc::check(MatMPIAIJSetPreallocationCSR(matrix, starts.data(), columns, values));
  if (symmetry == Symmetry::symmetric) {
    petsc::check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
    petsc::check(MatSetOption(matrix, MAT_SYMMETRY_ETERNAL, PETSC_TRUE));
  }
  return matrix;
}

}  // namespace chladni::cyclic
