#include "reduce/factorization.hpp"

#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include "reduce/cholesky_types.hpp"
#include "reduce/softest_motion.hpp"

namespace chladni::reduce {

namespace {

/// What the analysis found, before any arithmetic.
void check_memory(Mat factor, MatFactorError error, double budget_MiB)
{
  if (error != MAT_FACTOR_OUTMEMORY) return;
  throw Error(fmt::format(
      "factorize: the factor of K_ss needs {:.0f} MiB, and {}; use more machines, a coarser mesh, "
      "fewer masters or modes, or raise -cms_memory",
      forecast_MiB(factor),
      budget_MiB > 0.0 ? fmt::format("{:.0f} MiB are free for it", budget_MiB)
                       : "modes and constraint modes alone need more than there is"));
}

/// Zero where the package does not tell.
PetscInt n_negative_pivots(Mat factor)
{
  if (is_ours(factor)) return our_negative_pivots(factor);
  MatSolverType package = nullptr;
  PetscInt negative = 0;
  petsc::check(MatFactorGetSolverType(factor, &package));
  if (std::string_view(package) == MATSOLVERMUMPS)
    petsc::check(MatMumpsGetInfog(factor, 12, &negative));
  return negative;
}

[[noreturn]] void refuse(const std::string& why, PetscInt row)
{
  throw FreeMotion(fmt::format("factorize: K_ss is not positive definite ({}); a part of the body "
                               "can move while all masters are held: connect it to the rest, give "
                               "it an attachment node, or check for elements without stiffness",
                               why),
                   row);
}

/// Where A without a factor can move: from the factor of A with a larger diagonal; -1 if that has
/// none either.
PetscInt row_of_free_motion(Mat A)
{
  petsc::Matrix stiffer;
  petsc::Vector diagonal;
  petsc::check(MatDuplicate(A, MAT_COPY_VALUES, stiffer.put()));
  petsc::check(MatCreateVecs(A, diagonal.put(), nullptr));
  petsc::check(MatGetDiagonal(A, diagonal));
  constexpr double far_above_round_off = 1e-8;
  petsc::check(VecScale(diagonal, far_above_round_off));
  petsc::check(MatDiagonalSet(stiffer, diagonal, ADD_VALUES));
  petsc::Matrix factor;
  petsc::check(MatGetFactor(stiffer, supernodal, MAT_FACTOR_CHOLESKY, factor.put()));
  petsc::check(MatCholeskyFactorSymbolic(factor, stiffer, nullptr, nullptr));
  petsc::check(MatCholeskyFactorNumeric(factor, stiffer, nullptr));
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  if (error != MAT_FACTOR_NOERROR || n_negative_pivots(factor) > 0) return -1;
  return softest_motion(factor, A).row;
}

/// K_ss is singular or indefinite exactly when a part of the body can move with all masters held.
/// Round-off may hide that from the pivots, but not from the energy of the motion.
void check_definite(Mat factor, Mat A, double budget_MiB)
{
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  check_memory(factor, error, budget_MiB);
  if (error != MAT_FACTOR_NOERROR) refuse("zero pivot", row_of_free_motion(A));
  if (const PetscInt n = n_negative_pivots(factor); n > 0) {
    refuse(fmt::format("{} negative pivots", n), row_of_free_motion(A));
  }
  const SoftestMotion softest = softest_motion(factor, A);
  constexpr double round_off = 32.0 * std::numeric_limits<double>::epsilon();
  if (softest.stiffness < round_off) {
    refuse(fmt::format("a motion has a stiffness of {:.0e} of the diagonal", softest.stiffness),
           softest.row);
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
  petsc::check(KSPCreate(petsc::communicator(A), solver_.put()));
  petsc::check(KSPSetOptionsPrefix(solver_, "cms_"));
  petsc::check(KSPSetOperators(solver_, A, A));
  petsc::check(KSPSetType(solver_, KSPPREONLY));
  PC pc = nullptr;
  petsc::check(KSPGetPC(solver_, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  register_cholesky_types();
  petsc::check(PCFactorSetMatSolverType(pc, supernodal));
  petsc::check(KSPSetFromOptions(solver_));
  MatSolverType type = nullptr;
  petsc::check(PCFactorGetMatSolverType(pc, &type));
  if (std::string_view(type) == MATSOLVERMUMPS) set_default_option("-cms_mat_mumps_icntl_27", "64");
  petsc::check(PCFactorSetUpMatSolverType(pc));
  const double budget_MiB = budget(petsc::communicator(A), beside_MiB);
  set_budget(factor(), budget_MiB);
  petsc::check(KSPSetUp(solver_));
  check_definite(factor(), A, budget_MiB);
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
