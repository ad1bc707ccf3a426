#include "reduce/fixed_interface_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "reduce/block_lanczos.hpp"

namespace chladni::reduce {

namespace {

constexpr double pair_gap = 1e-4;   // relative distance of frequencies of one cluster
constexpr double tolerance = 1e-7;  // of the vectors; the error of lambda is its square

EigenPairs converged_pairs(EPS eps, Mat M_ss, PetscInt n_modes)
{
  PetscInt n = 0, n_local = 0, n_s = 0, n_iterations = 0;
  petsc::check(EPSGetConverged(eps, &n));
  petsc::check(EPSGetIterationNumber(eps, &n_iterations));
  if (n < n_modes) {
    throw Error(
        fmt::format("fixed_interface_modes: {} of {} modes converged in {} restarts; ask for "
                    "fewer modes or raise -cms_eps_ncv or -cms_eps_max_it",
                    n, n_modes, n_iterations));
  }
  petsc::check(MatGetLocalSize(M_ss, &n_local, nullptr));
  petsc::check(MatGetSize(M_ss, &n_s, nullptr));
  EigenPairs pairs{.lambda = {}, .residual = {}, .X = {}, .n_solves = 0};
  petsc::check(MatCreateDense(petsc::communicator(M_ss), n_local, PETSC_DECIDE, n_s, n, nullptr,
                              pairs.X.put()));
  for (PetscInt i = 0; i < n; ++i) {
    PetscScalar lambda = 0.0;
    Vec column = nullptr;
    petsc::check(MatDenseGetColumnVecWrite(pairs.X, i, &column));
    petsc::check(EPSGetEigenpair(eps, i, &lambda, nullptr, column, nullptr));
    petsc::check(MatDenseRestoreColumnVecWrite(pairs.X, i, &column));
    pairs.lambda.push_back(lambda);
  }
  return pairs;
}

/// An ST resets its solver when it is destroyed; the factor of K_ss must outlive it.
void take_back_solver(ST st)
{
  petsc::LinearSolver other;
  petsc::check(KSPCreate(petsc::communicator(st), other.put()));
  petsc::check(STSetKSP(st, other));
}

/// By SLEPc's Krylov-Schur, one column at a time.
EigenPairs krylov_schur(const Factorization& K_ss, Mat M_ss, PetscInt n_modes)
{
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(petsc::communicator(M_ss), eps.put()));
  petsc::check(EPSSetOptionsPrefix(eps, "cms_"));
  petsc::check(EPSSetOperators(eps, K_ss.matrix(), M_ss));
  petsc::check(EPSSetProblemType(eps, EPS_GHEP));
  petsc::check(EPSSetDimensions(eps, n_modes, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check(EPSSetTolerances(eps, tolerance, PETSC_DEFAULT));
  petsc::check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  petsc::check(EPSSetTarget(eps, 0.0));
  // Purification would cost one single solve for each mode and gains nothing at this tolerance.
  petsc::check(EPSSetPurify(eps, PETSC_FALSE));
  ST st = nullptr;
  petsc::check(EPSGetST(eps, &st));
  petsc::check(STSetType(st, STSINVERT));
  petsc::check(STSetShift(st, 0.0));
  petsc::check(STSetKSP(st, K_ss.solver()));  // the same matrix object: no second factorisation
  petsc::check(EPSSetFromOptions(eps));
  petsc::check(EPSSolve(eps));
  EigenPairs pairs = converged_pairs(eps, M_ss, n_modes);
  take_back_solver(st);
  return pairs;
}

/// "block-lanczos" (default) or "krylov-schur".
bool uses_krylov_schur()
{
  std::array<char, 64> name{};
  PetscBool given = PETSC_FALSE;
  petsc::check(PetscOptionsGetString(nullptr, nullptr, "-cms_modes_solver", name.data(),
                                     name.size(), &given));
  const std::string_view solver = given ? name.data() : "block-lanczos";
  if (solver != "block-lanczos" && solver != "krylov-schur") {
    throw Error(fmt::format("-cms_modes_solver {}: give block-lanczos or krylov-schur", solver));
  }
  return solver == "krylov-schur";
}

/// The value of an integer option, or what stands there without it.
PetscInt integer_option(const char* name, PetscInt otherwise)
{
  petsc::check(PetscOptionsGetInt(nullptr, nullptr, name, &otherwise, nullptr));
  return otherwise;
}

/// Larger blocks solve a column faster and need more columns: measured optima, flat ones.
PetscInt fastest_block_size(Mat M_ss)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(M_ss, &n, nullptr));
  constexpr PetscInt large = 100000;
  return n < large ? 8 : 12;
}

EigenPairs lowest_pairs(const Factorization& K_ss, Mat M_ss, PetscInt n_modes)
{
  return uses_krylov_schur()
             ? krylov_schur(K_ss, M_ss, n_modes)
             : block_lanczos(K_ss.factor(), M_ss,
                             {.n_pairs = n_modes,
                              .block_size = integer_option("-cms_lanczos_block_size", fastest_block_size(M_ss)),
                              .max_subspace = integer_option("-cms_lanczos_subspace", 0),
                              .tolerance = tolerance});
}

/// sqrt(lambda) where all are there and positive.
std::vector<double> angular_frequencies(const std::vector<double>& lambda, PetscInt n_modes)
{
  if (std::ssize(lambda) < n_modes) {
    throw Error(fmt::format("fixed_interface_modes: {} of {} modes found; M_ss has no more",
                            lambda.size(), n_modes));
  }
  std::vector<double> omega;
  for (const double value : lambda) {
    if (!(value > 0.0)) {
      throw Error(
          fmt::format("fixed_interface_modes: eigenvalue {} is not positive; a part of the "
                      "body is free while the masters are held",
                      value));
    }
    omega.push_back(std::sqrt(value));
  }
  return omega;
}

/// The first `n` modes and those that follow within the gap of one cluster.
PetscInt complete_cluster(const std::vector<double>& omega, PetscInt n)
{
  while (n > 0 && n < std::ssize(omega) && omega[n] - omega[n - 1] < pair_gap * omega[n]) ++n;
  return n;
}

/// The first n pairs; without a copy where these are all.
FixedInterfaceModes leading_modes(EigenPairs pairs, std::vector<double> omega, PetscInt n)
{
  if (n == std::ssize(omega)) return {.Phi = std::move(pairs.X), .omega = std::move(omega)};
  FixedInterfaceModes modes{.Phi = {}, .omega = std::move(omega)};
  modes.omega.resize(n);
  Mat columns = nullptr;
  petsc::check(MatDenseGetSubMatrix(pairs.X, PETSC_DECIDE, PETSC_DECIDE, 0, n, &columns));
  petsc::check(MatDuplicate(columns, MAT_COPY_VALUES, modes.Phi.put()));
  petsc::check(MatDenseRestoreSubMatrix(pairs.X, &columns));
  return modes;
}

/// Number of finite eigenvalues is at most the number of slaves.
void check_number(Mat M_ss, PetscInt n_modes)
{
  PetscInt n_s = 0;
  petsc::check(MatGetSize(M_ss, &n_s, nullptr));
  if (n_modes < 1 || n_modes > n_s) {
    throw Error(fmt::format("fixed_interface_modes: {} modes asked of {} slaves; give 1 to {}",
                            n_modes, n_s, n_s));
  }
}

/// More modes than wanted are computed, so that a partner of the last one is seen.
constexpr PetscInt n_guard_modes = 2;

FixedInterfaceModes modes_by_number(const Factorization& K_ss, Mat M_ss, PetscInt n_modes)
{
  check_number(M_ss, n_modes);
  PetscInt n_s = 0;
  petsc::check(MatGetSize(M_ss, &n_s, nullptr));
  const PetscInt n_asked = std::min(n_modes + n_guard_modes, n_s);
  EigenPairs pairs = lowest_pairs(K_ss, M_ss, n_asked);
  std::vector<double> omega = angular_frequencies(pairs.lambda, n_modes);
  const PetscInt n = complete_cluster(omega, n_modes);
  return leading_modes(std::move(pairs), std::move(omega), n);
}

FixedInterfaceModes modes_below(const Factorization& K_ss, Mat M_ss, double omega_cutoff)
{
  PetscInt n_s = 0;
  petsc::check(MatGetSize(M_ss, &n_s, nullptr));
  for (PetscInt n_asked = 32;; n_asked *= 2) {
    n_asked = std::min(n_asked, n_s);
    EigenPairs pairs = lowest_pairs(K_ss, M_ss, n_asked);
    std::vector<double> omega = angular_frequencies(pairs.lambda, 1);
    const auto n =
        static_cast<PetscInt>(std::ranges::lower_bound(omega, omega_cutoff) - omega.begin());
    if (n == std::ssize(omega) && n_asked < n_s) continue;
    if (n == 0) {
      throw Error(fmt::format(
          "fixed_interface_modes: no mode below {:.6g} Hz (the first is at {:.6g} "
          "Hz); raise cutoff_Hz or use Guyan",
          omega_cutoff / (2.0 * std::numbers::pi), omega.front() / (2.0 * std::numbers::pi)));
    }
    const PetscInt n_complete = complete_cluster(omega, n);
    return leading_modes(std::move(pairs), std::move(omega), n_complete);
  }
}

}  // namespace

FixedInterfaceModes fixed_interface_modes(const Factorization& K_ss, Mat M_ss,
                                          const ReduceOptions& wanted)
{
  if (wanted.modes) return modes_by_number(K_ss, M_ss, *wanted.modes);
  if (wanted.cutoff_Hz) {
    return modes_below(K_ss, M_ss, 2.0 * std::numbers::pi * *wanted.cutoff_Hz);
  }
  throw Error("fixed_interface_modes: give the number of modes or cutoff_Hz");
}

}  // namespace chladni::reduce
