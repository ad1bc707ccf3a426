#include "reduce/fixed_interface_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chladni::reduce {

namespace {

constexpr double pair_gap = 1e-4;  // relative distance of frequencies of one cluster
constexpr double tolerance = 1e-11;

petsc::EigenSolver shift_invert_solver(const Factorization& K_ss, Mat M_ss, PetscInt n_modes)
{
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(petsc::communicator(M_ss), eps.put()));
  petsc::check(EPSSetOptionsPrefix(eps, "cms_"));
  petsc::check(EPSSetOperators(eps, K_ss.matrix(), M_ss));
  petsc::check(EPSSetProblemType(eps, EPS_GHEP));
  petsc::check(EPSSetType(eps, EPSKRYLOVSCHUR));
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
  return eps;
}

std::vector<double> solve(EPS eps, PetscInt n_modes)
{
  petsc::check(EPSSolve(eps));
  PetscInt converged = 0;
  petsc::check(EPSGetConverged(eps, &converged));
  if (converged < n_modes) {
    throw Error(
        fmt::format("fixed_interface_modes: {} of {} modes converged; ask for fewer modes or "
                    "raise -cms_eps_ncv or -cms_eps_max_it",
                    converged, n_modes));
  }
  std::vector<double> omega;
  for (PetscInt i = 0; i < converged; ++i) {
    PetscScalar lambda = 0.0;
    petsc::check(EPSGetEigenvalue(eps, i, &lambda, nullptr));
    if (!(lambda > 0.0)) {
      throw Error(
          fmt::format("fixed_interface_modes: eigenvalue {} of mode {} is not positive; a "
                      "part of the body is free while the masters are held",
                      lambda, i + 1));
    }
    omega.push_back(std::sqrt(lambda));
  }
  return omega;
}

/// The first `n` modes and those that follow within the gap of one cluster.
PetscInt complete_cluster(const std::vector<double>& omega, PetscInt n)
{
  while (n > 0 && n < std::ssize(omega) && omega[n] - omega[n - 1] < pair_gap * omega[n]) ++n;
  return n;
}

FixedInterfaceModes copy_modes(EPS eps, Mat M_ss, std::vector<double> omega)
{
  PetscInt n_local = 0;
  PetscInt n_s = 0;
  petsc::check(MatGetLocalSize(M_ss, &n_local, nullptr));
  petsc::check(MatGetSize(M_ss, &n_s, nullptr));
  FixedInterfaceModes modes{.Phi = {}, .omega = std::move(omega)};
  const auto n_modes = static_cast<PetscInt>(modes.omega.size());
  petsc::check(MatCreateDense(petsc::communicator(M_ss), n_local, PETSC_DECIDE, n_s, n_modes,
                              nullptr, modes.Phi.put()));
  for (PetscInt i = 0; i < n_modes; ++i) {
    Vec column = nullptr;
    petsc::check(MatDenseGetColumnVecWrite(modes.Phi, i, &column));
    petsc::check(EPSGetEigenvector(eps, i, column, nullptr));
    petsc::check(MatDenseRestoreColumnVecWrite(modes.Phi, i, &column));
  }
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
  const petsc::EigenSolver eps = shift_invert_solver(K_ss, M_ss, n_asked);
  std::vector<double> omega = solve(eps, n_asked);
  omega.resize(complete_cluster(omega, n_modes));
  return copy_modes(eps, M_ss, std::move(omega));
}

FixedInterfaceModes modes_below(const Factorization& K_ss, Mat M_ss, double omega_cutoff)
{
  PetscInt n_s = 0;
  petsc::check(MatGetSize(M_ss, &n_s, nullptr));
  for (PetscInt n_asked = 32;; n_asked *= 2) {
    n_asked = std::min(n_asked, n_s);
    const petsc::EigenSolver eps = shift_invert_solver(K_ss, M_ss, n_asked);
    std::vector<double> omega = solve(eps, n_asked);
    const auto n =
        static_cast<PetscInt>(std::ranges::lower_bound(omega, omega_cutoff) - omega.begin());
    if (n == std::ssize(omega) && n_asked < n_s) continue;
    if (n == 0) {
      throw Error(fmt::format(
          "fixed_interface_modes: no mode below {:.6g} Hz (the first is at {:.6g} "
          "Hz); raise cutoff_Hz or use Guyan",
          omega_cutoff / (2.0 * std::numbers::pi), omega.front() / (2.0 * std::numbers::pi)));
    }
    omega.resize(complete_cluster(omega, n));
    return copy_modes(eps, M_ss, std::move(omega));
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
