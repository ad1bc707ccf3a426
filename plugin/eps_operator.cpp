#include "plugin/eps_operator.hpp"

#include <slepc/private/epsimpl.h>

namespace chladni::plugin {

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

/// Itself, or a copy of type AIJ, whose arrays the products read.
petsc::Matrix as_aij(petsc::Matrix B)
{
  PetscBool is_aij = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompareAny((PetscObject)(Mat)B, &is_aij, MATSEQAIJ, MATMPIAIJ, ""));
  if (is_aij) return B;
  // Of a copy: converting a distributed BAIJ matrix counts as a change of it, which the ST refuses.
  petsc::Matrix copy, aij;
  petsc::check(MatDuplicate(B, MAT_COPY_VALUES, copy.put()));
  petsc::check(MatConvert(copy, MATAIJ, MAT_INITIAL_MATRIX, aij.put()));
  return aij;
}

/// The factor of A - sigma B must have come about: a solver reports a zero pivot as a state.
void check_factor(EPS eps)
{
  KSP ksp = nullptr;
  PC pc = nullptr;
  PCFailedReason reason = PC_NOERROR;
  PetscScalar shift = 0.0;
  petsc::check(STGetKSP(eps->st, &ksp));
  petsc::check(KSPGetPC(ksp, &pc));
  petsc::check(PCGetFailedReason(pc, &reason));
  petsc::check(STGetShift(eps->st, &shift));
  int failed = reason == PC_NOERROR ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PetscObjectComm((PetscObject)eps));
  if (failed == 0) return;
  throw Error(
      fmt::format("blocklanczos: the factorisation of A - sigma B failed at sigma = {:.9g} ({}); "
                  "where sigma is an eigenvalue, give an -eps_target beside it",
                  shift, PCFailedReasons[reason]));
}

}  // namespace

petsc::Matrix inner_product_matrix(EPS eps)
{
  petsc::Matrix B;
  Mat of_basis = nullptr;
  petsc::check(BVGetMatrix(eps->V, &of_basis, nullptr));
  if (of_basis) {
    petsc::check(PetscObjectReference((PetscObject)of_basis));
    return as_aij(petsc::Matrix(of_basis));
  }
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

namespace {

/// Whether the basis has the inner product of the transformation, not one that was set by
/// BVSetMatrix after EPSSetUp.
bool has_own_inner_product(EPS eps)
{
  petsc::Matrix of_problem;
  Mat of_basis = nullptr;
  petsc::check(STGetBilinearForm(eps->st, of_problem.put()));
  petsc::check(BVGetMatrix(eps->V, &of_basis, nullptr));
  return of_basis == static_cast<Mat>(of_problem);
}

}  // namespace

linear::BlockOperator operator_of(EPS eps)
{
  if (!inverts(eps) || !has_own_inner_product(eps))
    return [eps](Mat Q, Mat, Mat Y) { apply_by_columns(eps->st, Q, Y); };
  check_factor(eps);
  return [eps](Mat, Mat BQ, Mat Y) { petsc::check(STMatMatSolve(eps->st, BQ, Y)); };
}

}  // namespace chladni::plugin
