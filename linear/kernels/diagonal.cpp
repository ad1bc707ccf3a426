#include "linear/kernels/diagonal.hpp"

#include <algorithm>

namespace chladni::linear {

namespace {

bool is_of_type(Mat A, MatType type)
{
  PetscBool is = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), type, &is));
  return is == PETSC_TRUE;
}

/// What holds the diagonal of this rank's rows, or null where that is no sequential AIJ matrix.
Mat sequential_part(Mat A)
{
  Mat own = A;
  if (is_of_type(A, MATMPIAIJ)) petsc::check(MatGetDiagonalBlock(A, &own));
  return is_of_type(own, MATSEQAIJ) ? own : nullptr;
}

/// @return false where some row has no entry there, or it is not found since the row is not in
/// order
bool read_diagonal(Mat own, PetscScalar* diagonal)
{
  PetscInt n = 0;
  const PetscInt *starts = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  const PetscScalar* values = nullptr;
  petsc::check(MatGetRowIJ(own, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts, &columns, &done));
  petsc::check(MatSeqAIJGetArrayRead(own, &values));
  bool has_all = done == PETSC_TRUE;
  for (PetscInt i = 0; i < n && has_all; ++i) {
    const PetscInt* end = columns + starts[i + 1];
    const PetscInt* found = std::lower_bound(columns + starts[i], end, i);
    has_all = found != end && *found == i;
    if (has_all) diagonal[i] = values[found - columns];
  }
  petsc::check(MatSeqAIJRestoreArrayRead(own, &values));
  petsc::check(MatRestoreRowIJ(own, 0, PETSC_FALSE, PETSC_FALSE, &n, &starts, &columns, &done));
  return has_all;
}

}  // namespace

petsc::Vector diagonal(Mat A)
{
  petsc::Vector d;
  petsc::check(MatCreateVecs(A, nullptr, d.put()));
  int has_all = 0;
  if (Mat own = sequential_part(A); own != nullptr) {
    PetscScalar* values = nullptr;
    petsc::check(VecGetArrayWrite(d, &values));
    has_all = read_diagonal(own, values) ? 1 : 0;
    petsc::check(VecRestoreArrayWrite(d, &values));
  }
  MPI_Allreduce(MPI_IN_PLACE, &has_all, 1, MPI_INT, MPI_MIN, petsc::communicator(A));
  if (has_all == 0) petsc::check(MatGetDiagonal(A, d));
  return d;
}

}  // namespace chladni::linear
