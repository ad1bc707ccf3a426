#include "plugin/eps_operator.hpp"

#include <slepc/private/epsimpl.h>
#include <slepc/private/stimpl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"

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
petsc::Matrix copied_as_aij(petsc::Matrix B)
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
  PetscBool has_factor = PETSC_FALSE;
  petsc::check(
      PetscObjectTypeCompareAny((PetscObject)eps->st, &has_factor, STSINVERT, STCAYLEY, ""));
  if (has_factor == PETSC_FALSE) return;
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

petsc::Matrix identity(EPS eps)
{
  petsc::Matrix I;
  PetscInt first = 0, last = 0;
  petsc::check(MatCreateAIJ(PetscObjectComm((PetscObject)eps), eps->nloc, eps->nloc, eps->n, eps->n,
                            1, nullptr, 0, nullptr, I.put()));
  petsc::check(MatGetOwnershipRange(I, &first, &last));
  for (PetscInt i = first; i < last; ++i) petsc::check(MatSetValue(I, i, i, 1.0, INSERT_VALUES));
  petsc::check(MatAssemblyBegin(I, MAT_FINAL_ASSEMBLY));
  petsc::check(MatAssemblyEnd(I, MAT_FINAL_ASSEMBLY));
  return I;
}

/// A negative diagonal value shows at once that B is no inner product; block Lanczos finds others.
void refuse_negative_diagonal(Mat B)
{
  PetscInt row = 0;
  PetscReal least = 0.0;
  petsc::check(VecMin(linear::diagonal(B), &row, &least));
  if (!(least < 0.0)) return;
  throw Error(
      fmt::format("blocklanczos: B has {:.6g} on its diagonal in row {}: it is the inner product "
                  "and must be positive semidefinite; use -eps_type krylovschur "
                  "-eps_gen_indefinite",
                  least, row));
}

/// Plain AIJ; the identity for none.
petsc::Matrix mass(EPS eps, Mat B)
{
  if (B == nullptr) return identity(eps);
  petsc::check(PetscObjectReference((PetscObject)B));
  petsc::Matrix copy = copied_as_aij(petsc::Matrix(B));
  refuse_negative_diagonal(copy);
  return copy;
}

}  // namespace

petsc::Matrix inner_product_matrix(EPS eps)
{
  Mat of_basis = nullptr;
  petsc::check(BVGetMatrix(eps->V, &of_basis, nullptr));
  return mass(eps, of_basis);
}

ProblemMatrices problem_matrices(EPS eps)
{
  // EPSGetOperators refuses an A that the transformation has changed in place.
  const ST st = eps->st;
  return {.A = st->A[0], .B = st->nmat > 1 ? st->A[1] : nullptr};
}

double shift_in_place(EPS eps)
{
  const ST st = eps->st;
  const bool is_changed = ((PetscObject)st->A[0])->state != st->Astate[0];
  return st->matmode == ST_MATMODE_INPLACE && is_changed ? PetscRealPart(st->sigma) : 0.0;
}

petsc::Matrix stiffness_of(EPS eps)
{
  const Mat A = problem_matrices(eps).A;
  petsc::check(PetscObjectReference((PetscObject)A));
  petsc::Matrix copy = copied_as_aij(petsc::Matrix(A));
  const double taken = shift_in_place(eps);
  return taken == 0.0 ? std::move(copy) : linear::shifted(copy, mass_of(eps), -taken);
}

petsc::Matrix mass_of(EPS eps)
{
  return mass(eps, problem_matrices(eps).B);
}

bool inverts(EPS eps)
{
  PetscBool sinvert = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSINVERT, &sinvert));
  return sinvert == PETSC_TRUE;
}

bool has_own_inner_product(EPS eps)
{
  Mat of_basis = nullptr;
  petsc::check(BVGetMatrix(eps->V, &of_basis, nullptr));
  return of_basis == problem_matrices(eps).B;
}

namespace {

/// R <- R - (A - sigma B) Y by columns, and the largest ratio of its columns to the lengths given.
/// Columns with a ratio up to `enough` become zero.
double take_residual(EPS eps, Mat Y, const std::vector<double>& lengths, double enough, Mat R)
{
  const auto [A, B] = problem_matrices(eps);
  PetscScalar sigma = 0.0;
  petsc::check(STGetShift(eps->st, &sigma));
  petsc::Vector w;
  petsc::check(MatCreateVecs(A, w.put(), nullptr));
  double largest = 0.0;
  for (std::size_t j = 0; j < lengths.size(); ++j) {
    Vec y = nullptr, r = nullptr;
    PetscReal length = 0.0;
    petsc::check(MatDenseGetColumnVecRead(Y, static_cast<PetscInt>(j), &y));
    petsc::check(MatDenseGetColumnVec(R, static_cast<PetscInt>(j), &r));
    petsc::check(MatMult(A, y, w));
    petsc::check(VecAXPY(r, -1.0, w));
    if (B) petsc::check(MatMult(B, y, w));
    petsc::check(VecAXPY(r, sigma - shift_in_place(eps), B ? Vec(w) : y));
    petsc::check(VecNorm(r, NORM_2, &length));
    const double ratio = lengths[j] > 0.0 ? length / lengths[j] : 0.0;
    if (ratio <= enough) petsc::check(VecSet(r, 0.0));
    largest = std::max(largest, ratio);
    petsc::check(MatDenseRestoreColumnVec(R, static_cast<PetscInt>(j), &r));
    petsc::check(MatDenseRestoreColumnVecRead(Y, static_cast<PetscInt>(j), &y));
  }
  return largest;
}

/// A deflation space C, and B C.
struct Deflated {
  Mat C = nullptr;
  petsc::Matrix BC;
};

/// Y <- Y + (A - sigma B)^-1 R where the solver converges; what a round-off of R asks for may have
/// no solution.
/// @return whether it does
bool add_solution(EPS eps, Mat R, Mat Y)
{
  KSP ksp = nullptr;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  petsc::Matrix correction;
  petsc::check(STGetKSP(eps->st, &ksp));
  petsc::check(MatDuplicate(R, MAT_DO_NOT_COPY_VALUES, correction.put()));
  petsc::check(KSPSetErrorIfNotConverged(ksp, PETSC_FALSE));
  petsc::check(STMatMatSolve(eps->st, R, correction));
  petsc::check(KSPSetErrorIfNotConverged(ksp, PETSC_TRUE));  // as the ST has it
  petsc::check(KSPGetConvergedReason(ksp, &reason));
  if (reason >= 0) petsc::check(MatAXPY(Y, 1.0, correction, SAME_NONZERO_PATTERN));
  return reason >= 0;
}

/// Y <- (A - sigma B)^-1 R with a solver that iterates, which solves for what it has left until the
/// residual is a hundredth of the tolerance of the pairs: the recurrence must be that of one
/// operator.
void solve_to_tolerance(EPS eps, const Deflated& deflated, Mat R, Mat Y)
{
  constexpr int most = 6;
  constexpr double gain = 0.5;
  const double enough = 0.01 * eps->tol;
  petsc::check(STMatMatSolve(eps->st, R, Y));
  std::vector<double> lengths = linear::column_products(R, R);
  for (double& length : lengths) length = std::sqrt(length);
  double before = 1.0;
  for (int pass = 0; pass < most; ++pass) {
    petsc::Matrix rest;
    petsc::check(MatDuplicate(R, MAT_COPY_VALUES, rest.put()));
    const double left = take_residual(eps, Y, lengths, enough, rest);
    if (left <= enough || left > gain * before) return;
    if (deflated.C)
      linear::add_product(-1.0, deflated.BC, linear::inner_product(deflated.C, rest), rest);
    if (!add_solution(eps, rest, Y)) return;
    before = left;
  }
}

linear::BlockOperator whole_operator_of(EPS eps, const std::shared_ptr<const Deflated>& deflated)
{
  check_factor(eps);
  if (!inverts(eps) || !has_own_inner_product(eps))
    return [eps](Mat Q, Mat, Mat Y) { apply_by_columns(eps->st, Q, Y); };
  if (is_direct(eps))
    return [eps](Mat, Mat BQ, Mat Y) { petsc::check(STMatMatSolve(eps->st, BQ, Y)); };
  return [=](Mat, Mat BQ, Mat Y) { solve_to_tolerance(eps, *deflated, BQ, Y); };
}

}  // namespace

bool is_direct(EPS eps)
{
  PetscBool is_shift = PETSC_FALSE, is_shell = PETSC_FALSE, is_once = PETSC_FALSE,
            is_factor = PETSC_FALSE;
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSHIFT, &is_shift));
  petsc::check(PetscObjectTypeCompare((PetscObject)eps->st, STSHELL, &is_shell));
  if (is_shell) return false;
  if (is_shift && !eps->isgeneralized) return true;
  KSP ksp = nullptr;
  PC pc = nullptr;
  petsc::check(STGetKSP(eps->st, &ksp));
  petsc::check(KSPGetPC(ksp, &pc));
  petsc::check(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &is_once));
  petsc::check(
      PetscObjectTypeCompareAny((PetscObject)pc, &is_factor, PCLU, PCCHOLESKY, PCREDUNDANT, ""));
  return is_once == PETSC_TRUE && is_factor == PETSC_TRUE;
}

petsc::Matrix deflation_space(EPS eps)
{
  petsc::Matrix C;
  if (eps->nds <= 0) return C;
  petsc::check(MatCreateDense(PetscObjectComm((PetscObject)eps), eps->nloc, PETSC_DECIDE, eps->n,
                              eps->nds, nullptr, C.put()));
  for (PetscInt j = 0; j < eps->nds; ++j) {
    Vec from = nullptr, to = nullptr;
    petsc::check(BVGetColumn(eps->V, j - eps->nds, &from));
    petsc::check(MatDenseGetColumnVecWrite(C, j, &to));
    petsc::check(VecCopy(from, to));
    petsc::check(MatDenseRestoreColumnVecWrite(C, j, &to));
    petsc::check(BVRestoreColumn(eps->V, j - eps->nds, &from));
  }
  return C;
}

linear::BlockOperator operator_of(EPS eps, Mat C)
{
  const auto deflated = std::make_shared<Deflated>();  // a function object is copied
  if (C != nullptr) {
    deflated->C = C;
    petsc::check(MatMatMult(inner_product_matrix(eps), C, MAT_INITIAL_MATRIX, PETSC_DEFAULT,
                            deflated->BC.put()));
  }
  linear::BlockOperator op = whole_operator_of(eps, deflated);
  if (C == nullptr) return op;
  return [=](Mat Q, Mat BQ, Mat Y) {  // Y - C C^T B Y
    op(Q, BQ, Y);
    linear::add_product(-1.0, C, linear::inner_product(deflated->BC, Y), Y);
  };
}

namespace {

/// For the Rayleigh quotients of a transformation without an inverse.
PetscErrorCode sort_projected_values_alike(EPS eps)
{
  SlepcSC projected = nullptr;
  PetscFunctionBegin;
  PetscCall(DSGetSlepcSC(eps->ds, &projected));
  projected->comparison = eps->sc->comparison;
  projected->comparisonctx = eps->sc->comparisonctx;
  projected->map = nullptr;
  projected->mapobj = nullptr;
  projected->rg = nullptr;
  PetscFunctionReturn(0);
}

PetscErrorCode set_up_own_sort(EPS eps)
{
  PetscFunctionBegin;
  eps->sc->map = nullptr;
  eps->sc->mapobj = nullptr;
  if (eps->which == EPS_WHICH_USER)
    PetscFunctionReturn(0);  // EPSSetEigenvalueComparison has set it
  eps->sc->comparisonctx = nullptr;
  switch (eps->which) {
    case EPS_LARGEST_MAGNITUDE:
      eps->sc->comparison = SlepcCompareLargestMagnitude;
      break;
    case EPS_SMALLEST_MAGNITUDE:
      eps->sc->comparison = SlepcCompareSmallestMagnitude;
      break;
    case EPS_LARGEST_REAL:
      eps->sc->comparison = SlepcCompareLargestReal;
      break;
    case EPS_SMALLEST_REAL:
      eps->sc->comparison = SlepcCompareSmallestReal;
      break;
    case EPS_TARGET_MAGNITUDE:
    case EPS_TARGET_REAL:  // the same for real eigenvalues
      eps->sc->comparison = SlepcCompareTargetMagnitude;
      eps->sc->comparisonctx = &eps->target;
      break;
    case EPS_ALL:
      eps->sc->comparison = SlepcCompareSmallestReal;
      break;
    default:
      SETERRQ(PetscObjectComm((PetscObject)eps), PETSC_ERR_SUP,
              "blocklanczos: the eigenvalues of a symmetric problem have no imaginary part; use "
              "another -eps_which");
  }
  PetscFunctionReturn(0);
}

}  // namespace

PetscErrorCode set_up_sort(EPS eps)
{
  PetscFunctionBegin;
  PetscCall(set_up_own_sort(eps));
  PetscCall(sort_projected_values_alike(eps));
  PetscFunctionReturn(0);
}

bool comes_before(EPS eps, PetscScalar a, PetscScalar b)
{
  PetscScalar zero_a = 0.0, zero_b = 0.0;
  PetscInt order = 0;
  petsc::check(STBackTransform(eps->st, 1, &a, &zero_a));
  petsc::check(STBackTransform(eps->st, 1, &b, &zero_b));
  petsc::check(eps->sc->comparison(a, 0.0, b, 0.0, &order, eps->sc->comparisonctx));
  return order < 0;
}

}  // namespace chladni::plugin
