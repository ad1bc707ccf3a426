#include "reduce/factorization.hpp"

#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "reduce/mumps_metis.hpp"

namespace chladni::reduce {

namespace {

/// K_ss is singular or indefinite exactly when a part of the body can move with all masters held.
void check_definite(Mat factor, double budget_MiB)
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
    throw Error(fmt::format(
        "factorize: the factor of K_ss needs {:.0f} MiB, and {:.0f} MiB are free for it; use more "
        "machines, a coarser mesh, fewer masters or modes, or raise -cms_memory",
        forecast_MiB(factor), budget_MiB));
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

/// MiB that a process may still take on this machine, by the kernel's estimate.
double free_MiB()
{
  std::ifstream meminfo("/proc/meminfo");
  std::string name, unit;
  double KiB = 0.0;
  while (meminfo >> name >> KiB) {
    if (name == "MemAvailable:") return KiB / 1024.0;
    std::getline(meminfo, unit);
  }
  return std::numeric_limits<double>::infinity();
}

/// What the factor may take: -cms_memory, or else what the emptiest machine has free.
double budget(MPI_Comm comm, double beside_MiB)
{
  PetscReal allowed = 0.0;
  PetscBool given = PETSC_FALSE;
  petsc::check(PetscOptionsGetReal(nullptr, nullptr, "-cms_memory", &allowed, &given));
  double MiB = given ? allowed : free_MiB();
  MPI_Allreduce(MPI_IN_PLACE, &MiB, 1, MPI_DOUBLE, MPI_MIN, comm);
  return MiB - beside_MiB;
}

}  // namespace

Factorization::Factorization(Mat A, double beside_MiB)
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
  petsc::check(PCFactorSetUpMatSolverType(pc));
  const double budget_MiB = budget(petsc::communicator(A), beside_MiB);
  set_budget(factor(), budget_MiB);
  petsc::check(KSPSetUp(solver_));
  check_definite(factor(), budget_MiB);
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

Factorization factorize(Mat K_ss, double beside_MiB)
{
  return Factorization(K_ss, beside_MiB);
}

}  // namespace chladni::reduce
