#include "reduce/plugin/eps_operator.hpp"

#include <slepc/private/epsimpl.h>

namespace chladni::reduce::plugin {

namespace {

/// Y <- Op Q column by column: SLEPc 3.18 has no STApplyMat for the transformation "shift".
void apply_by_columns(ST st, Mat Q, Mat Y)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(Q, nullptr, &n));
  for (PetscInt j = 0; j < n; ++j) {
    Vec q = nullptr, y = nullptr;
    petsc::check(MatDenseGetColumnVecRead(Q, j, &q));
    petsc::check(MatDenseGetColumnVecWrite(Y, j, &y));
    petsc::check(STApply(st, q, y));
    petsc::check(MatDenseRestoreColumnVecWrite(Y, j, &y));
    petsc::check(MatDenseRestoreColumnVecRead(Q, j, &q));
  }
}

}  // namespace

petsc::Matrix inner_product_matrix(EPS eps)
{
  petsc::Matrix B;
  petsc::check(STGetBilinearForm(eps->st, B.put()));
  if (B) return B;
  PetscInt first = 0, last = 0;
  petsc::check(MatCreateAIJ(PetscObjectComm((PetscObject)eps), eps->nloc, eps->nloc, eps->n, eps->n,
                            1, nullptr, 0, nullptr, B.put()));
  petsc::check(MatGetOwnershipRange(B, &first, &last));
  for (PetscInt i = first; i < last; ++i) petsc::check(MatSetValue(B, i, i, 1.0, INSERT_VALUES));
  petsc::check(MatAssemblyBegin(B, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(B, MAT_FINAL_ASSEMBLY));
  return B;
}

bool inverts(EPS eps)
{
  PetscBool sinvert = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSINVERT, &sinvert));
  return sinvert == PETSC_TRUE;
}

BlockOperator operator_of(EPS eps)
{
  if (!inverts(eps)) {
    return [eps](Mat Q, Mat, Mat Y) { apply_by_columns(eps->st, Q, Y); };
  }
  return [eps](Mat, Mat BQ, Mat Y) { petsc::check(STMatMatSolve(eps->st, BQ, Y)); };
}

}  // namespace chladni::reduce::plugin
