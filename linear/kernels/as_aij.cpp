#include "linear/kernels/as_aij.hpp"

#include <vector>

#include "linear/kernels/dense_matrices.hpp"

namespace chladni::linear {

petsc::Matrix as_aij(Mat A)
{
  const auto object = reinterpret_cast<PetscObject>(A);
  PetscBool is_plain = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompareAny(object, &is_plain, MATSEQAIJ, MATMPIAIJ, ""));
  if (is_plain) {
    petsc::check(PetscObjectReference(object));
    return petsc::Matrix(A);
  }
  petsc::Matrix copy;
  petsc::check(MatConvert(A, MATAIJ, MAT_INITIAL_MATRIX, copy.put()));
  return copy;
}

petsc::Matrix with_ascending_rows(petsc::Matrix A)
{
  PetscInt before_row = -1, before_column = -1, n_local = 0, n = 0, first = 0;
  int is_unsorted = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  std::vector<PetscInt> n_in_row(std::size_t(n_local), 0);
  for_local_entries(A, [&](PetscInt row, PetscInt column, double) {
    if (row == before_row && column <= before_column) is_unsorted = 1;
    before_row = row;
    before_column = column;
    ++n_in_row[std::size_t(row - first)];
  });
  const MPI_Comm comm = petsc::communicator(A);
  MPI_Allreduce(MPI_IN_PLACE, &is_unsorted, 1, MPI_INT, MPI_MAX, comm);
  if (is_unsorted == 0) return A;
  petsc::Matrix sum;
  // Each row may stand in the part of this rank or in that of others.
  petsc::check(MatCreateAIJ(comm, n_local, n_local, n, n, 0, n_in_row.data(), 0, n_in_row.data(),
                            sum.put()));
  for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    petsc::check(MatSetValue(sum, row, column, value, ADD_VALUES));
  });
  petsc::check(MatAssemblyBegin(sum, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(sum, MAT_FINAL_ASSEMBLY));
  return sum;
}

}  // namespace chladni::linear
