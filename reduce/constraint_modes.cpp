#include "reduce/constraint_modes.hpp"

#include <algorithm>

#include "linear/cholesky/cholesky_types.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/scratch.hpp"

namespace chladni::reduce {

namespace {

constexpr PetscInt block_columns = 64;  // right-hand sides at a time: bounds the memory

/// Columns first to last of the sparse A, copied into the zeroed dense B.
void copy_columns(Mat A, PetscInt first, PetscInt last, Mat B)
{
  petsc::check(MatZeroEntries(B));
  linear::for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    if (column < first || column >= last) return;
    petsc::check(MatSetValue(B, row, column - first, value, INSERT_VALUES));
  });
  petsc::check(MatAssemblyBegin(B, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(B, MAT_FINAL_ASSEMBLY));
}

/// -K_ss^-1 K_sm block by block. PETSc 3.18 fails with sparse right-hand sides on several ranks
/// where a rank has none (MUMPS error -27), and its dense ones are gathered: blocks keep that
/// small.
void solve_by_blocks(Mat factor, Mat K_sm, Mat Psi)
{
  PetscInt n_m = 0;
  petsc::check(MatGetSize(Psi, nullptr, &n_m));
  for (PetscInt first = 0; first < n_m; first += block_columns) {
    const PetscInt last = std::min(first + block_columns, n_m);
    Mat X = nullptr;
    petsc::Matrix B;
    petsc::check(MatDenseGetSubMatrix(Psi, PETSC_DECIDE, PETSC_DECIDE, first, last, &X));
    petsc::check(MatDuplicate(X, MAT_DO_NOT_COPY_VALUES, B.put()));
    copy_columns(K_sm, first, last, B);
    petsc::check(MatScale(B, -1.0));  // not Psi at once: its numbers may be more than PETSc counts
    petsc::check(MatMatSolve(factor, B, X));
    petsc::check(MatDenseRestoreSubMatrix(Psi, &X));
  }
}

}  // namespace

petsc::Matrix constraint_modes(const linear::Factorization& K_ss, const Blocks& K)
{
  PetscInt n_m = 0;
  petsc::check(MatGetSize(K.ms, &n_m, nullptr));
  petsc::Matrix Psi = linear::large_dense(K.ss, n_m, K_ss.options().scratch);
  if (petsc::size(petsc::communicator(K.ms)) == 1 || linear::is_ours(K_ss.factor())) {
    petsc::Matrix minus_K_ms;
    petsc::check(MatDuplicate(K.ms, MAT_COPY_VALUES, minus_K_ms.put()));
    petsc::check(MatScale(minus_K_ms, -1.0));
    petsc::check(MatMatTransposeSolve(K_ss.factor(), minus_K_ms, Psi));
  } else {
    solve_by_blocks(K_ss.factor(), K.sm, Psi);
  }
  return Psi;
}

}  // namespace chladni::reduce
