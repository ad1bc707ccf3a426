#include "linear/cholesky/factorization.hpp"

#include <limits>
#include <string>
#include <string_view>

#include "linear/cholesky/cholesky_types.hpp"
#include "linear/cholesky/inner_solver.hpp"
#include "linear/cholesky/softest_motion.hpp"

namespace chladni::linear {

namespace {

/// What the analysis found, before any arithmetic.
void check_memory(Mat factor, MatFactorError error, const FactorOptions& options)
{
  if (error != MAT_FACTOR_OUTMEMORY) return;
  const MemoryNeed need = memory_need(factor);
  const auto on_machine = [&](double own_MiB) {
    return tightest_machine(own_MiB, need.free_MiB, petsc::communicator(factor));
  };
  const MemoryNeed beside = on_machine(options.beside_MiB), there = on_machine(resident_MiB());
  throw Error(fmt::format(
      "factorize: the factor of K_ss and what comes beside it need {}{:.0f} MiB on one machine "
      "besides up to {:.0f} MiB that are taken, where {:.0f} MiB are free{}; use more machines, a "
      "coarser mesh, fewer masters or modes, "
      "-cms_scratch or a larger -cms_memory",
      options.is_least ? "at least " : "", need.needed_MiB, there.needed_MiB, need.free_MiB,
      beside.fits() ? "" : ": modes and constraint modes alone need more than there is"));
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
  require_definite(factor);
  petsc::check(MatCholeskyFactorSymbolic(factor, stiffer, nullptr, nullptr));
  petsc::check(MatCholeskyFactorNumeric(factor, stiffer, nullptr));
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  if (error != MAT_FACTOR_NOERROR || n_negative_pivots(factor) > 0) return -1;
  return softest_motion(factor, A).row;
}

/// K_ss is singular or indefinite exactly when a part of the body can move with all masters held.
/// Round-off may hide that from the pivots, but not from the energy of the motion.
void check_definite(Mat factor, Mat A, const FactorOptions& options)
{
  MatFactorError error = MAT_FACTOR_NOERROR;
  petsc::check(MatFactorGetError(factor, &error));
  check_memory(factor, error, options);
  if (const PetscInt n = n_negative_pivots(factor); n > 0)
    refuse(fmt::format("{} negative pivots", n), row_of_free_motion(A));
  if (error != MAT_FACTOR_NOERROR) refuse("zero pivot", row_of_free_motion(A));
  const SoftestMotion softest = softest_motion(factor, A);
  constexpr double round_off = 32.0 * std::numeric_limits<double>::epsilon();
  if (softest.stiffness < round_off) {
    refuse(fmt::format("a motion has a stiffness of {:.0e} of the diagonal", softest.stiffness),
           softest.row);
  }
}

}  // namespace

Factorization::Factorization(Mat A, SolverOptions options) : options_(std::move(options))
{
  petsc::check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  solver_ = new_solver(petsc::communicator(A), options_.petsc);
  petsc::check(KSPSetOperators(solver_, A, A));
  petsc::check(KSPSetType(solver_, KSPPREONLY));
  PC pc = nullptr;
  petsc::check(KSPGetPC(solver_, &pc));
  petsc::check(PCSetType(pc, PCCHOLESKY));
  register_cholesky_types();
  petsc::check(PCFactorSetMatSolverType(pc, supernodal));
  petsc::check(KSPSetFromOptions(solver_));
  set_up_factor(pc, options_.petsc);
  const FactorOptions& allowed = options_.factor;
  const MemoryBudget budget{.machine_MiB = allowed.memory_MiB.value_or(free_MiB()),
                            .beside_MiB = allowed.beside_MiB,
                            .second = allowed.second};
  set_budget(factor(), budget);
  require_definite(factor());
  petsc::check(KSPSetUp(solver_));
  check_definite(factor(), A, allowed);
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

Factorization factorize(Mat K_ss, const SolverOptions& options)
{
  return Factorization(K_ss, options);
}

}  // namespace chladni::linear
