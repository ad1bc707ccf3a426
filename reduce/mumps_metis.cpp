#include "reduce/mumps_metis.hpp"

#include <petsc/private/matimpl.h>

#include <memory>
#include <string_view>

#include "reduce/mumps_metis_solve.hpp"

namespace chladni::reduce {

namespace {

/// What went wrong, in PETSc's words.
MatFactorError failure(int info)
{
  if (info >= 0) return MAT_FACTOR_NOERROR;
  if (info == -10 || info == -6 || info == -40) return MAT_FACTOR_NUMERIC_ZEROPIVOT;
  if (info == -7 || info == -8 || info == -9 || info == -11 || info == -13 || info == -19) {
    return MAT_FACTOR_OUTMEMORY;
  }
  return MAT_FACTOR_OTHER;
}

PetscErrorCode factorize(Mat F, Mat A, const MatFactorInfo*)
{
  return guarded([&] {
    factor_of(F).factorize(A);
    F->factorerrortype = failure(factor_of(F).info(1));
    F->assembled = PETSC_TRUE;
    F->ops->solve = solve_vector;
    F->ops->solvetranspose = solve_vector;
    F->ops->matsolve = solve_block;
    F->ops->matsolvetranspose = solve_block;
    F->ops->mattransposesolve = solve_sparse;
  });
}

PetscErrorCode analyze(Mat F, Mat A, IS, const MatFactorInfo*)
{
  F->ops->choleskyfactornumeric = factorize;
  return guarded([&] {
    MumpsFactor& factor = factor_of(F);
    factor.analyze(A);
    F->factorerrortype = failure(factor.info(1));
    if (factor.forecast_MiB() > factor.budget_MiB) F->factorerrortype = MAT_FACTOR_OUTMEMORY;
  });
}

PetscErrorCode destroy(Mat F)
{
  delete static_cast<MumpsFactor*>(F->data);
  F->data = nullptr;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatFactorGetSolverType_C",
                                       nullptr));
  PetscCall(
      PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatMumpsGetInfog_C", nullptr));
  return 0;
}

PetscErrorCode solver_type(Mat, MatSolverType* type)
{
  *type = mumps_metis;
  return 0;
}

PetscErrorCode get_infog(Mat F, PetscInt index, PetscInt* value)
{
  *value = factor_of(F).info(index);
  return 0;
}

/// MUMPS gives a large number of entries in millions, with a minus.
double n_entries(const MumpsFactor& factor)
{
  constexpr int entries_of_factor = 29;  // INFOG
  const int entries = factor.info(entries_of_factor);
  return entries < 0 ? -1e6 * entries : entries;
}

PetscErrorCode get_info(Mat F, MatInfoType, MatInfo* info)
{
  *info = {};
  info->nz_used = info->nz_allocated = n_entries(factor_of(F));
  return 0;
}

PetscErrorCode view(Mat F, PetscViewer viewer)
{
  const MumpsFactor& factor = factor_of(F);
  constexpr int ordering_used = 7;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "MUMPS, ordering %s: %.3g operations, %d MiB on all ranks\n",
                                   factor.control(ordering_used) == 1 ? "by METIS" : "by MUMPS",
                                   factor.real_info(3), factor.info(19)));
  return 0;
}

void set_from_options(MumpsFactor& factor, const char* prefix)
{
  constexpr int n_integer = 40, n_real = 15;
  for (int i = 1; i <= n_integer; ++i) {
    PetscInt value = 0;
    PetscBool given = PETSC_FALSE;
    petsc::check(PetscOptionsGetInt(nullptr, prefix, fmt::format("-mat_mumps_icntl_{}", i).c_str(),
                                    &value, &given));
    if (given) factor.set_control(i, value);
  }
  for (int i = 1; i <= n_real; ++i) {
    PetscReal value = 0;
    PetscBool given = PETSC_FALSE;
    petsc::check(PetscOptionsGetReal(nullptr, prefix, fmt::format("-mat_mumps_cntl_{}", i).c_str(),
                                     &value, &given));
    if (given) factor.set_control(i, value);
  }
}

PetscErrorCode create_factor(Mat A, MatFactorType type, Mat* F)
{
  Mat B = nullptr;
  PetscCall(MatCreate(petsc::communicator(A), &B));
  PetscCall(MatSetSizes(B, A->rmap->n, A->cmap->n, A->rmap->N, A->cmap->N));
  PetscCall(PetscStrallocpy(mumps_metis, &reinterpret_cast<PetscObject>(B)->type_name));
  PetscCall(MatSetUp(B));
  const PetscErrorCode code = guarded([&] {
    auto factor = std::make_unique<MumpsFactor>(petsc::communicator(A));
    set_from_options(*factor,
                     A->factorprefix ? A->factorprefix : reinterpret_cast<PetscObject>(A)->prefix);
    B->data = factor.release();
  });
  PetscCall(code);
  B->ops->choleskyfactorsymbolic = analyze;
  B->ops->destroy = destroy;
  B->ops->view = view;
  B->ops->getinfo = get_info;
  B->factortype = type;
  B->canuseordering = PETSC_FALSE;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(B), "MatFactorGetSolverType_C",
                                       solver_type));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(B), "MatMumpsGetInfog_C",
                                       get_infog));
  PetscCall(PetscFree(B->solvertype));
  PetscCall(PetscStrallocpy(mumps_metis, &B->solvertype));
  *F = B;
  return 0;
}

/// The C++ object behind a factor of our type, otherwise null.
MumpsFactor* ours(Mat F)
{
  MatSolverType type = nullptr;
  petsc::check(MatFactorGetSolverType(F, &type));
  return std::string_view(type) == mumps_metis ? &factor_of(F) : nullptr;
}

}  // namespace

void set_budget(Mat F, double MiB)
{
  if (MumpsFactor* factor = ours(F)) factor->budget_MiB = MiB;
}

FactorSize factor_size(Mat F)
{
  const MumpsFactor* factor = ours(F);
  if (factor == nullptr) return {.operations = 0.0, .entries = 0.0};
  constexpr int operations = 3;  // RINFOG
  return {.operations = factor->real_info(operations), .entries = n_entries(*factor)};
}

double forecast_MiB(Mat F)
{
  const MumpsFactor* factor = ours(F);
  return factor ? factor->forecast_MiB() : 0.0;
}

void register_mumps_metis()
{
  static bool registered = false;
  if (registered) return;
  // PETSc 3.18 reads its list of solvers before it fills it on the first call: it would forget all
  // of its own ones where this is that call, as under -dll_append.
  petsc::check(MatInitializePackage());
  for (const MatType type : {MATSEQAIJ, MATMPIAIJ}) {
    petsc::check(MatSolverTypeRegister(mumps_metis, type, MAT_FACTOR_CHOLESKY, create_factor));
  }
  registered = true;
}

}  // namespace chladni::reduce
