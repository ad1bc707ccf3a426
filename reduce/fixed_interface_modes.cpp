#include "reduce/fixed_interface_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/petsc.hpp"
#include "common/told_apart.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

FixedInterfaceModes modes_by_number(ModeSearch& search, PetscInt n_modes)
{
  if (n_modes < 1 || n_modes > search.n_slaves()) {
    throw Error(fmt::format("fixed_interface_modes: {} modes asked of {} slaves; give 1 to {}",
                            n_modes, search.n_slaves(), search.n_slaves()));
  }
  search.find(n_modes);
  if (std::ssize(search.omega()) < n_modes) {
    search.require_resolved(linear::all_of_them);
    throw Error(
        fmt::format("fixed_interface_modes: {} of {} modes found; M_ss has no more: ask for fewer",
                    search.omega().size(), n_modes));
  }
  return search.leading(search.complete_cluster(n_modes));
}

FixedInterfaceModes modes_below(ModeSearch& search, const ReduceOptions& wanted)
{
  const double omega_cutoff = 2.0 * std::numbers::pi * *wanted.cutoff_Hz;
  const std::vector<double>& omega = search.omega();
  PetscInt n_asked = 0;
  PetscInt n_found = 0;
  do {  // half as many more, until one is above or there are no others
    n_found = static_cast<PetscInt>(omega.size());
    n_asked = std::max<PetscInt>(wanted.expected, n_found + n_found / 2);
    search.find(n_asked);
    if (omega.empty()) {
      search.require_resolved(linear::all_of_them);
      throw Error("fixed_interface_modes: no mode found; M_ss is zero or indefinite, use Guyan");
    }
  } while (omega.back() < omega_cutoff && std::ssize(omega) > n_found);
  search.require_resolved(std::pow(omega_cutoff, 2));
  const auto n_below =
      static_cast<PetscInt>(std::ranges::lower_bound(omega, omega_cutoff) - omega.begin());
  const auto n_there = static_cast<PetscInt>(omega.size());
  const PetscInt n = std::max(n_below, std::min<PetscInt>(wanted.at_least, n_there));
  if (n > 0) return search.leading(search.complete_cluster(n));
  const auto [first_Hz, cutoff_Hz] = told_apart(omega.front() / (2.0 * std::numbers::pi),
                                                omega_cutoff / (2.0 * std::numbers::pi), 6);
  throw Error(
      fmt::format("fixed_interface_modes: no mode below {} Hz (the first is at {} Hz); raise "
                  "cutoff_Hz or use Guyan",
                  cutoff_Hz, first_Hz));
}

}  // namespace

FixedInterfaceModes fixed_interface_modes(const linear::Factorization& K_ss, Mat M_ss,
                                          const ReduceOptions& wanted,
                                          const MemoryCheck& require_memory)
{
  ModeSearch search(K_ss, M_ss, require_memory);
  if (wanted.modes) return modes_by_number(search, *wanted.modes);
  if (wanted.cutoff_Hz) return modes_below(search, wanted);
  throw Error("fixed_interface_modes: give the number of modes or cutoff_Hz");
}

namespace {

constexpr double cluster_gap = 1e-4;  // relative distance of frequencies of one cluster

linear::EigenPairs converged_pairs(EPS eps, Mat M_ss, PetscInt n_modes)
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
  linear::EigenPairs pairs{.lambda = {}, .residual = {}, .X = {}, .n_solves = 0};
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
linear::EigenPairs krylov_schur(const linear::Factorization& K_ss, Mat M_ss, PetscInt n_modes)
{
  petsc::EigenSolver eps;
  petsc::check(EPSCreate(petsc::communicator(M_ss), eps.put()));
  linear::set_options_source(eps, K_ss.options().petsc);
  petsc::check(EPSSetOperators(eps, K_ss.matrix(), M_ss));
  petsc::check(EPSSetProblemType(eps, EPS_GHEP));
  petsc::check(EPSSetDimensions(eps, n_modes, petsc::automatic, petsc::automatic));
  petsc::check(EPSSetTolerances(eps, K_ss.options().lanczos.tolerance, petsc::automatic));
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
  linear::EigenPairs pairs = converged_pairs(eps, M_ss, n_modes);
  take_back_solver(st);
  return pairs;
}

linear::BlockLanczosOptions block_options(const linear::SolverOptions& options)
{
  return {.n_pairs = 0,
          .block_size = options.lanczos.block_size,
          .max_subspace = options.lanczos.subspace,
          .tolerance = options.lanczos.tolerance,
          .scratch = options.scratch};
}

/// By parts where K_ss and M_ss have some and the factor solves for them.
linear::PartedLanczos lanczos(const linear::Factorization& K_ss, Mat M_ss)
{
  const linear::BlockLanczosOptions options = block_options(K_ss.options());
  if (!linear::solves_for_parts(K_ss.factor())) return {K_ss.factor(), M_ss, options};
  std::vector<linear::DecoupledPart> parts;
  for (petsc::IndexSet& rows : linear::decoupled_rows(K_ss.matrix(), M_ss)) {
    linear::BlockSolve solve = linear::part_solver(K_ss.factor(), rows);
    parts.push_back({.rows = std::move(rows), .solve = std::move(solve)});
  }
  if (parts.empty()) return {K_ss.factor(), M_ss, options};
  return {std::move(parts), M_ss, options};
}

double angular_frequency(double lambda)
{
  if (lambda > 0.0) return std::sqrt(lambda);
  throw Error(
      fmt::format("fixed_interface_modes: eigenvalue {} is not positive: a part of the body is "
                  "free while the masters are held; connect it to the rest or give it a master",
                  lambda));
}

}  // namespace

ModeSearch::ModeSearch(const linear::Factorization& K_ss, Mat M_ss, MemoryCheck require_memory)
    : K_ss_(K_ss), M_ss_(M_ss), require_memory_(std::move(require_memory))
{
  petsc::check(MatGetSize(M_ss, &n_s_, nullptr));
  if (K_ss.options().lanczos.solver == linear::ModeSolver::block_lanczos)
    lanczos_.emplace(lanczos(K_ss, M_ss));
}

void ModeSearch::find_by_krylov_schur(PetscInt n)
{
  linear::EigenPairs pairs = krylov_schur(K_ss_, M_ss_, n);
  X_ = std::move(pairs.X);
  omega_.clear();
  for (const double lambda : pairs.lambda) omega_.push_back(angular_frequency(lambda));
}

void ModeSearch::find_all(PetscInt n)
{
  n = std::min(n, n_s_);
  if (n <= std::ssize(omega_) || has_all_) return;
  if (require_memory_) require_memory_(n);
  if (lanczos_) {
    lanczos_->converge(n);
    omega_.clear();
    for (PetscInt i = 0; i < lanczos_->n_pairs(); ++i)
      omega_.push_back(angular_frequency(lanczos_->lambda(i)));
  } else {
    find_by_krylov_schur(n);
  }
  has_all_ = std::ssize(omega_) < n || std::ssize(omega_) == n_s_;
}

void ModeSearch::find(PetscInt n)
{
  constexpr PetscInt n_guard_modes = 2;  // so that a partner of the last one is seen
  const auto n_found = [&] { return static_cast<PetscInt>(omega_.size()); };
  PetscInt n_before = -1;
  for (PetscInt n_more = n_guard_modes; n_before < n_found(); n_more *= 2) {
    n_before = n_found();
    find_all(n + n_more);
    // A cluster that ends with what is found may go on: frequencies of more than two modes.
    if (complete_cluster(std::min(n, n_found())) < n_found()) break;
  }
}

PetscInt ModeSearch::complete_cluster(PetscInt n) const
{
  while (n > 0 && n < std::ssize(omega_) && omega_[n] - omega_[n - 1] < cluster_gap * omega_[n])
    ++n;
  return n;
}

petsc::Matrix ModeSearch::shapes(PetscInt first, PetscInt last) const
{
  if (lanczos_) return lanczos_->vectors(first, last);
  petsc::Matrix columns;
  petsc::check(MatDuplicate(linear::ColumnRange(X_, first, last), MAT_COPY_VALUES, columns.put()));
  return columns;
}

FixedInterfaceModes ModeSearch::leading(PetscInt n) const
{
  return {.Phi = shapes(0, n), .omega = {omega_.begin(), omega_.begin() + n}};
}

namespace {

/// Squares of the lengths of K phi - lambda M phi and of lambda M phi, column by column.
MatrixXd squared_lengths(Mat K_Phi, Mat M_Phi, const double* omega)
{
  const linear::LocalRows k(K_Phi), m(M_Phi);
  MatrixXd sums = MatrixXd::Zero(2, k.n_cols());
  for (PetscInt j = 0; j < k.n_cols(); ++j) {
    const double lambda = omega[j] * omega[j];
    for (PetscInt i = 0; i < k.n_rows(); ++i) {
      const double inertia = lambda * m(i, j);
      const double difference = k(i, j) - inertia;
      sums(0, j) += difference * difference;
      sums(1, j) += inertia * inertia;
    }
  }
  linear::sum_over_ranks(linear::values_of(sums), petsc::communicator(K_Phi));
  return sums;
}

}  // namespace

double largest_residual(const FixedInterfaceModes& modes, Mat K_ss, Mat M_ss)
{
  const PetscInt most = linear::columns_at_a_time(K_ss);
  const auto n = static_cast<PetscInt>(modes.omega.size());
  double largest = 0.0;
  for (PetscInt first = 0; first < n; first += most) {
    const PetscInt last = std::min(first + most, n);
    const petsc::Matrix K_Phi = linear::uninitialized_dense(K_ss, last - first);
    const petsc::Matrix M_Phi = linear::uninitialized_dense(K_ss, last - first);
    const linear::ColumnRange Phi(modes.Phi, first, last);
    linear::SparseProduct(K_ss).apply(Phi, K_Phi);
    linear::SparseProduct(M_ss).apply(Phi, M_Phi);
    const MatrixXd lengths = squared_lengths(K_Phi, M_Phi, modes.omega.data() + first);
    for (PetscInt j = 0; j < lengths.cols(); ++j)
      largest = std::max(largest, std::sqrt(lengths(0, j) / lengths(1, j)));
  }
  return largest;
}

}  // namespace chladni::reduce
