#include "reduce/factorization.hpp"

#include <string_view>

#include "reduce/mumps_metis.hpp"

namespace chladni::reduce {

namespace {

/// K_ss is singular or indefinite exactly when a part of the body can move with all masters held.
void check_definite(Mat factor)
{
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  PetscInt negative = 0;
  MatSolverType package = nullptr;
  petsc::check(MatFactorGetSolverType(factor, &package));
  if (error == MAT_FACTOR_NOERROR &&
      (std::string_view(package) == MATSOLVERMUMPS || std::string_view(package) == mumps_metis)) {
    petsc::check(MatMumpsGetInfog(factor, 12, &negative));
  }
  if (error == MAT_FACTOR_OUTMEMORY) {
    throw Error(
        "factorize: not enough memory for the factor of K_ss; use more ranks on more "
        "machines or a coarser mesh");
  }
  if (error != MAT_FACTOR_NOERROR || negative > 0) {
    throw Error(fmt::format(
        "factorize: K_ss is not positive definite ({}); a part of the body can move while all "
        "masters are held: connect it to the rest, give it an attachment node, or check for "
        "elements without stiffness",
        negative > 0 ? fmt::format("{} negative pivots", negative) : "zero pivot"));
  }
}

/// 64 columns at a time are fastest for the hundreds of right-hand sides of the constraint modes.
void set_default_option(const char* name, const char* value)
{
  PetscBool given = PETSC_FALSE;
  petsc::check(PetscOptionsHasName(nullptr, nullptr, name, &given));
  if (!given) petsc::check(PetscOptionsSetValue(nullptr, name, value));
}

}  // namespace

Factorization::Factorization(Mat A)
{
  petsc::check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  set_default_option("-cms_mat_mumps_icntl_27", "64");
  petsc::check(KSPCreate(petsc::communicator(A), solver_.put()));
  petsc::check(KSPSetOptionsPrefix(solver_, "cms_"));
  petsc::check(KSPSetOperators(solver_, A, A));
  petsc::check(KSPSetType(solver_, KSPPREONLY));
  PC pc = nullptr;
  petsc::check(KSPGetPC(solver_, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  register_mumps_metis();
  petsc::check(PCFactorSetMatSolverType(pc, mumps_metis));
  petsc::check(KSPSetFromOptions(solver_));
  petsc::check(KSPSetUp(solver_));
  check_definite(factor());
}

Mat Factorization::factor() const
{
  PC pc = nullptr;
  Mat factor = nullptr;
  petsc::check(KSPGetPC(solver_, &pc));
  petsc::check(PCFactorGetMatrix(pc, &factor));
  return factor;
}

Mat Factorization::matrix() const
{
  Mat A = nullptr;
  petsc::check(KSPGetOperators(solver_, &A, nullptr));
  return A;
}

Factorization factorize(Mat K_ss)
{
  return Factorization(K_ss);
}

}  // namespace chladni::reduce
