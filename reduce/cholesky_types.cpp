#include "reduce/cholesky_types.hpp"

#include <petsc/private/matimpl.h>

#include <memory>
#include <string_view>

#include "reduce/cholesky_callbacks.hpp"
#include "reduce/mumps_factor.hpp"
#include "reduce/supernodal/supernodal_factor.hpp"

namespace chladni::reduce {

namespace {

PetscErrorCode factorize(Mat F, Mat A, const MatFactorInfo*)
{
  return guarded([&] {
    factor_of(F).factorize(A);
    F->factorerrortype = factor_of(F).error();
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
    CholeskyFactor& factor = factor_of(F);
    factor.analyze(A);
    F->factorerrortype = factor.error();
    if (factor.forecast_MiB() > factor.budget_MiB) F->factorerrortype = MAT_FACTOR_OUTMEMORY;
  });
}

PetscErrorCode destroy(Mat F)
{
  delete static_cast<CholeskyFactor*>(F->data);
  F->data = nullptr;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatFactorGetSolverType_C",
                                       nullptr));
  PetscCall(
      PetscObjectComposeFunction(reinterpret_cast<PetscObject>(F), "MatMumpsGetInfog_C", nullptr));
  return 0;
}

PetscErrorCode solver_type(Mat F, MatSolverType* type)
{
  *type = F->solvertype;
  return 0;
}

PetscErrorCode get_infog(Mat F, PetscInt index, PetscInt* value)
{
  *value = dynamic_cast<const MumpsFactor&>(factor_of(F)).info(index);
  return 0;
}

PetscErrorCode get_info(Mat F, MatInfoType, MatInfo* info)
{
  *info = {};
  info->nz_used = info->nz_allocated = factor_of(F).size().entries;
  return 0;
}

PetscErrorCode view(Mat F, PetscViewer viewer)
{
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", factor_of(F).description().c_str()));
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

std::unique_ptr<CholeskyFactor> new_mumps_factor(Mat A)
{
  auto factor = std::make_unique<MumpsFactor>(petsc::communicator(A));
  set_from_options(*factor,
                   A->factorprefix ? A->factorprefix : reinterpret_cast<PetscObject>(A)->prefix);
  return factor;
}

std::unique_ptr<CholeskyFactor> new_supernodal_factor(Mat A)
{
  return std::make_unique<SupernodalFactor>(petsc::communicator(A));
}

PetscErrorCode create_factor(Mat A, MatFactorType type, const char* name,
                             std::unique_ptr<CholeskyFactor> (*make)(Mat), Mat* F)
{
  Mat B = nullptr;
  PetscCall(MatCreate(petsc::communicator(A), &B));
  PetscCall(MatSetSizes(B, A->rmap->n, A->cmap->n, A->rmap->N, A->cmap->N));
  PetscCall(PetscStrallocpy(name, &reinterpret_cast<PetscObject>(B)->type_name));
  PetscCall(MatSetUp(B));
  PetscCall(guarded([&] { B->data = make(A).release(); }));
  B->ops->choleskyfactorsymbolic = analyze;
  B->ops->destroy = destroy;
  B->ops->view = view;
  B->ops->getinfo = get_info;
  B->factortype = type;
  B->canuseordering = PETSC_FALSE;
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(B), "MatFactorGetSolverType_C",
                                       solver_type));
  PetscCall(PetscFree(B->solvertype));
  PetscCall(PetscStrallocpy(name, &B->solvertype));
  *F = B;
  return 0;
}

PetscErrorCode create_mumps_metis(Mat A, MatFactorType type, Mat* F)
{
  PetscCall(create_factor(A, type, mumps_metis, new_mumps_factor, F));
  PetscCall(PetscObjectComposeFunction(reinterpret_cast<PetscObject>(*F), "MatMumpsGetInfog_C",
                                       get_infog));
  return 0;
}

PetscErrorCode create_supernodal(Mat A, MatFactorType type, Mat* F)
{
  PetscCall(create_factor(A, type, supernodal, new_supernodal_factor, F));
  return 0;
}

/// The C++ object behind a factor of our types, otherwise null.
CholeskyFactor* ours(Mat F)
{
  MatSolverType type = nullptr;
  petsc::check(MatFactorGetSolverType(F, &type));
  const bool is_ours =
      std::string_view(type) == mumps_metis || std::string_view(type) == supernodal;
  return is_ours ? &factor_of(F) : nullptr;
}

}  // namespace

bool is_ours(Mat F)
{
  return ours(F) != nullptr;
}

void set_budget(Mat F, double MiB)
{
  if (CholeskyFactor* factor = ours(F)) factor->budget_MiB = MiB;
}

PetscInt our_negative_pivots(Mat F)
{
  return factor_of(F).n_negative_pivots();
}

FactorSize factor_size(Mat F)
{
  const CholeskyFactor* factor = ours(F);
  return factor ? factor->size() : FactorSize{.operations = 0.0, .entries = 0.0};
}

double forecast_MiB(Mat F)
{
  const CholeskyFactor* factor = ours(F);
  return factor ? factor->forecast_MiB() : 0.0;
}

void register_cholesky_types()
{
  static bool registered = false;
  if (registered) return;
  // PETSc 3.18 reads its list of solvers before it fills it on the first call: it would forget all
  // of its own ones where this is that call, as under -dll_append.
  petsc::check(MatInitializePackage());
  for (const MatType type : {MATSEQAIJ, MATMPIAIJ}) {
    petsc::check(MatSolverTypeRegister(mumps_metis, type, MAT_FACTOR_CHOLESKY, create_mumps_metis));
    petsc::check(MatSolverTypeRegister(supernodal, type, MAT_FACTOR_CHOLESKY, create_supernodal));
  }
  registered = true;
}

}  // namespace chladni::reduce
