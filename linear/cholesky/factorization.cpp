#include "linear/cholesky/factorization.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "common/petsc.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"

namespace chladni::linear {

namespace {

/// The motion z that a symmetric positive semidefinite A resists least.
struct SoftestMotion {
  double stiffness;  ///< z^T A z / z^T diag(A) z; of the size of round-off if nothing holds z
  PetscInt row;      ///< row in which z is largest
};

constexpr PetscInt n_vectors = 4;

/// Values without any regularity over the rows, the same for any number of ranks.
void fill(Mat Z)
{
  PetscScalar* values = nullptr;
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(Z, &first, &last));
  petsc::check(MatDenseGetArrayWrite(Z, &values));
  for (PetscInt j = 0; j < n_vectors; ++j)
    for (PetscInt i = first; i < last; ++i)
      values[i - first + std::size_t(j) * (last - first)] = std::sin(1.0 + (j + 1.3) * i) + 0.5;
  petsc::check(MatDenseRestoreArrayWrite(Z, &values));
}

/// Largest component of column j, in the lengths that the diagonal d gives.
PetscInt largest_row(Mat Z, PetscInt j, Vec d)
{
  petsc::Vector z;
  Vec column = nullptr;
  PetscInt row = 0;
  petsc::check(VecDuplicate(d, z.put()));
  petsc::check(VecCopy(d, z));
  petsc::check(VecSqrtAbs(z));
  petsc::check(MatDenseGetColumnVecRead(Z, j, &column));
  petsc::check(VecPointwiseMult(z, z, column));
  petsc::check(MatDenseRestoreColumnVecRead(Z, j, &column));
  petsc::check(VecAbs(z));
  PetscReal largest = 0.0;
  petsc::check(VecMax(z, &row, &largest));
  return row;
}

/// Finds the softest motion by two inverse iterations with a few deterministic vectors.
/// @param factor  of A, or of A with a slightly larger diagonal
/// @note   Collective; two block solves.
SoftestMotion softest_motion(Mat factor, Mat A)
{
  const petsc::Vector d = diagonal(A);
  const petsc::Matrix Z = uninitialized_dense(A, n_vectors);
  const petsc::Matrix DZ = uninitialized_dense(A, n_vectors);
  const petsc::Matrix AZ = uninitialized_dense(A, n_vectors);
  fill(Z);
  for (int iteration = 0; iteration < 2; ++iteration) {
    petsc::check(MatCopy(Z, DZ, SAME_NONZERO_PATTERN));
    petsc::check(MatDiagonalScale(DZ, d, nullptr));
    petsc::check(MatMatSolve(factor, DZ, Z));
    PetscReal norm = 0.0;
    petsc::check(MatNorm(Z, NORM_FROBENIUS, &norm));
    petsc::check(MatScale(Z, 1.0 / norm));
  }
  SparseProduct(A).apply(Z, AZ);
  petsc::check(MatCopy(Z, DZ, SAME_NONZERO_PATTERN));
  petsc::check(MatDiagonalScale(DZ, d, nullptr));
  const Eigen::MatrixXd Z_AZ = inner_product(Z, AZ), Z_DZ = inner_product(Z, DZ);
  SoftestMotion softest{.stiffness = std::numeric_limits<double>::infinity(), .row = 0};
  for (PetscInt j = 0; j < n_vectors; ++j) {
    const double stiffness = std::abs(Z_AZ(j, j)) / Z_DZ(j, j);
    if (stiffness < softest.stiffness) softest = {.stiffness = stiffness, .row = j};
  }
  softest.row = largest_row(Z, softest.row, d);
  return softest;
}

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

namespace {

/// A^-1 x.
petsc::Vector solved(const Factorization& A, Vec x)
{
  petsc::Vector y;
  petsc::check(VecDuplicate(x, y.put()));
  petsc::check(MatSolve(A.factor(), x, y));
  return y;
}

/// x_i <- sign(x_i), of zero 1.
void take_signs(Vec x)
{
  PetscInt n = 0;
  PetscScalar* values = nullptr;
  petsc::check(VecGetLocalSize(x, &n));
  petsc::check(VecGetArray(x, &values));
  for (PetscInt i = 0; i < n; ++i) values[i] = values[i] < 0.0 ? -1.0 : 1.0;
  petsc::check(VecRestoreArray(x, &values));
}

/// |A^-1|_1 of a symmetric A: climbs to a unit vector e_j whose |A^-1 e_j|_1 is a local maximum.
double inverse_norm(const Factorization& A)
{
  constexpr int most_steps = 3;
  petsc::Vector x;
  petsc::check(MatCreateVecs(A.matrix(), x.put(), nullptr));
  PetscInt n = 0;
  petsc::check(VecGetSize(x, &n));
  petsc::check(VecSet(x, 1.0 / n));
  double norm = 0.0;
  for (int step = 0; step < most_steps; ++step) {
    petsc::Vector y = solved(A, x);
    double now = 0.0;
    petsc::check(VecNorm(y, NORM_1, &now));
    if (now <= norm) break;
    norm = now;
    take_signs(y);
    const petsc::Vector z = solved(A, y);  // gradient; A is symmetric
    petsc::check(VecAbs(z));
    PetscInt steepest = 0;
    double largest = 0.0;
    petsc::check(VecMax(z, &steepest, &largest));
    petsc::check(VecSet(x, 0.0));
    if (petsc::rank(petsc::communicator(x)) == 0)
      petsc::check(VecSetValue(x, steepest, 1.0, INSERT_VALUES));
    petsc::check(VecAssemblyBegin(x));
    petsc::check(VecAssemblyEnd(x));
  }
  return norm;
}

}  // namespace

double condition_estimate(const Factorization& A)
{
  double norm = 0.0;
  petsc::check(MatNorm(A.matrix(), NORM_1, &norm));
  return norm * inverse_norm(A);
}

}  // namespace chladni::linear
