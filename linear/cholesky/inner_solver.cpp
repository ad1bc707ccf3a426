#include "linear/cholesky/inner_solver.hpp"

#include <string_view>

#include "linear/cholesky/cholesky_types.hpp"

namespace chladni::linear {

namespace {

void refuse_other_preconditioners(PC pc, const std::string& prefix)
{
  PetscBool is_cholesky = PETSC_FALSE;
  PCType type = nullptr;
  petsc::check(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &is_cholesky));
  if (is_cholesky) return;
  petsc::check(PCGetType(pc, &type));
  throw Error(
      fmt::format("-{0}pc_type {1}: only the factor of a symmetric matrix (cholesky) will do here; "
                  "leave the option out and choose the package by -{0}pc_factor_mat_solver_type",
                  prefix, type));
}

/// Of an object's own database, which neither PETSc nor MatGetFactor know.
void set_own_mumps_controls(Mat factor, const OptionSource& source)
{
  constexpr int n_integer = 40, n_real = 15;
  PetscBool given = PETSC_FALSE;
  for (int i = 1; i <= n_integer; ++i) {
    PetscInt value = 0;
    petsc::check(PetscOptionsGetInt(source.database, source.prefix.c_str(),
                                    fmt::format("-mat_mumps_icntl_{}", i).c_str(), &value, &given));
    if (given) petsc::check(MatMumpsSetIcntl(factor, i, value));
  }
  for (int i = 1; i <= n_real; ++i) {
    PetscReal value = 0.0;
    petsc::check(PetscOptionsGetReal(source.database, source.prefix.c_str(),
                                     fmt::format("-mat_mumps_cntl_{}", i).c_str(), &value, &given));
    if (given) petsc::check(MatMumpsSetCntl(factor, i, value));
  }
}

/// Of PETSc's interface; ours has them from the start.
void set_default_mumps_controls(Mat factor)
{
  constexpr PetscInt nowhere = -1;
  for (const PetscInt stream : {1, 2, 3})  // errors, diagnostics, statistics
    petsc::check(MatMumpsSetIcntl(factor, stream, nowhere));
  petsc::check(MatMumpsSetIcntl(factor, 4, 0));    // level
  petsc::check(MatMumpsSetIcntl(factor, 27, 64));  // columns at a time
}

}  // namespace

petsc::LinearSolver new_solver(MPI_Comm comm, const OptionSource& source)
{
  petsc::LinearSolver solver;
  petsc::check(KSPCreate(comm, solver.put()));
  petsc::check(PetscObjectSetOptions((PetscObject)(KSP)solver, source.database));
  petsc::check(KSPSetOptionsPrefix(solver, source.prefix.c_str()));
  return solver;
}

void set_options_source(EPS eps, const OptionSource& source)
{
  petsc::check(PetscObjectSetOptions((PetscObject)eps, source.database));
  petsc::check(EPSSetOptionsPrefix(eps, source.prefix.c_str()));
}

Mat set_up_factor(PC pc, const OptionSource& source)
{
  Mat factor = nullptr;
  MatSolverType package = nullptr;
  refuse_other_preconditioners(pc, source.prefix);
  petsc::check(PCFactorSetUpMatSolverType(pc));
  petsc::check(PCFactorGetMatrix(pc, &factor));
  petsc::check(MatFactorGetSolverType(factor, &package));
  const bool by_petsc = std::string_view(package) == MATSOLVERMUMPS;
  if (by_petsc) set_default_mumps_controls(factor);
  if (source.database && (by_petsc || std::string_view(package) == mumps_metis))
    set_own_mumps_controls(factor, source);
  return factor;
}

}  // namespace chladni::linear
