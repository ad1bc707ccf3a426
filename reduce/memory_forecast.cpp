#include "reduce/memory_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "common/petsc.hpp"
#include "linear/cholesky/part_solver.hpp"
#include "linear/cholesky/petsc_factor.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/machine_memory.hpp"
#include "reduce/basis.hpp"
#include "reduce/certify.hpp"

namespace chladni::reduce {

namespace {

double own_MiB(Mat A)
{
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_LOCAL, &info));
  constexpr double for_each_entry = sizeof(PetscScalar) + sizeof(PetscInt);
  return for_each_entry * info.nz_used / linear::bytes_in_MiB;
}

/// Whether a search finds out how many modes there are to be.
bool grows(const ReduceOptions& wanted)
{
  return wanted.method != Method::guyan && !wanted.modes;
}

/// In which a tolerance tries a reduced model of n DOFs while the basis of block Lanczos waits.
double trials_MiB(double n)
{
  constexpr double n_matrices = 12.0;
  return n_matrices * sizeof(double) * n * n / linear::bytes_in_MiB;
}

double modes_at_first(const ReduceOptions& wanted)
{
  if (wanted.method == Method::guyan) return 0.0;
  constexpr double of_a_search = 50.0;
  return wanted.modes ? *wanted.modes : of_a_search;
}

/// Of the factor of a shell of n DOFs before its analysis, as discs of 70,000 to a million DOFs
/// have it.
linear::FactorSize usual_size(double n)
{
  const double entries = n * std::max(1.0, 19.2 * std::log(n) - 107.0);
  const double operations = entries * entries / n * std::max(1.0, 0.58 * std::log(n) - 4.9);
  return {.operations = operations, .entries = entries};
}

/// Whether eigenvalues may be counted where the options do not say; the factor alone tells surely.
bool may_count(const ReductionOptions& options, double n_slaves, double n_masters)
{
  const ReduceOptions& basis = options.basis;
  if (basis.method != Method::guyan && !basis.modes) return true;  // K and M wait for the search
  const double n_modes = basis.method == Method::guyan ? 0.0 : *basis.modes;
  constexpr double sure = 2.0;
  return share_of_counts(usual_size(n_slaves), n_slaves, n_masters, n_modes) <
         sure * cheap_share_of_counts;
}

}  // namespace

bool needs_matrices(const ReductionOptions& options, bool counts)
{
  return options.keeps_matrices || counts || has_free_masters(options.basis.method);
}

bool lets_matrices_go_at_once(const ReductionOptions& options)
{
  return !needs_matrices(options, options.count.value_or(true));
}

namespace {

/// Of the entries of constraint modes the share in the parts that their masters move, the others
/// being zero.
double share_in_parts(const std::vector<petsc::IndexSet>& parts, Mat K_sm)
{
  PetscInt first = 0, last = 0, n_s = 0, n_m = 0;
  petsc::check(MatGetOwnershipRange(K_sm, &first, &last));
  petsc::check(MatGetSize(K_sm, &n_s, &n_m));
  std::vector<std::size_t> part_of(std::size_t(last - first));
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const PetscInt row : petsc::own_rows(parts[p], K_sm)) part_of[std::size_t(row)] = p;
  std::vector<int> moves(parts.size() * std::size_t(n_m), 0);  // [parts x masters]
  linear::for_local_entries(K_sm, [&](PetscInt row, PetscInt master, double value) {
    const std::size_t part = part_of[std::size_t(row - first)];
    if (value != 0.0) moves[part * std::size_t(n_m) + std::size_t(master)] = 1;
  });
  MPI_Allreduce(MPI_IN_PLACE, moves.data(), static_cast<int>(moves.size()), MPI_INT, MPI_MAX,
                petsc::communicator(K_sm));
  double entries = 0.0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    PetscInt n_rows = 0;
    petsc::check(ISGetSize(parts[p], &n_rows));
    const auto of_part = std::span(moves).subspan(p * std::size_t(n_m), std::size_t(n_m));
    entries += double(n_rows) * double(std::ranges::count(of_part, 1));
  }
  return n_m == 0 ? 0.0 : entries / (double(n_s) * n_m);
}

}  // namespace

MemoryForecast::MemoryForecast(const Body& body, const Blocks& K, const Blocks& M,
                               const ReductionOptions& options)
    : options_(options), n_masters_(static_cast<double>(body.masters.size()))
{
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(K.ss, &n_local, nullptr));
  petsc::check(MatGetSize(K.ss, &n, nullptr));
  n_slaves_ = static_cast<double>(n);
  column_MiB_ = sizeof(double) * double(n_local) / linear::bytes_in_MiB;
  K_MiB_ = own_MiB(body.K);
  M_MiB_ = own_MiB(body.M);
  const linear::SolverOptions& solver = options.solver;
  if (solver.lanczos.solver == linear::ModeSolver::block_lanczos &&
      linear::will_solve_for_parts(solver.petsc)) {
    if (has_free_masters(options.basis.method))
      take_parts(body.K, body.M, nullptr);
    else
      take_parts(K.ss, M.ss, K.sm);
  }
  const bool may_let_go =
      !needs_matrices(options, options.count.value_or(false)) && !lets_matrices_go_at_once(options);
  let_go_MiB_ = may_let_go && !may_count(options, n_slaves_, n_masters_) ? K_MiB_ + M_MiB_ : 0.0;
  columns_at_a_time_ = linear::columns_at_a_time(K.ss);
  in_memory_ = solver.scratch.empty() ? 1.0 : 0.0;
}

/// @param K_sm  null where K and M have the masters, each of which moves the part that it is in
void MemoryForecast::take_parts(Mat K, Mat M, Mat K_sm)
{
  const std::vector<petsc::IndexSet> parts = linear::decoupled_rows(K, M);
  if (parts.empty()) return;
  PetscInt n_largest = 0, n_all = 0;
  petsc::check(MatGetSize(K, &n_all, nullptr));
  for (const petsc::IndexSet& part : parts) {
    PetscInt n_rows = 0;
    petsc::check(ISGetSize(part, &n_rows));
    n_largest = std::max(n_largest, n_rows);
  }
  largest_part_ = double(n_largest) / n_all;
  part_of_Psi_ = K_sm == nullptr ? largest_part_ : share_in_parts(parts, K_sm);
  mass_of_parts_ = own_MiB(M);
}

/// Pairs are looked at in blocks: their motions, their residuals, which become half a solution, a
/// product with its workspace, and a panel of the factor. Bounds keep the half solutions of all.
double MemoryForecast::columns_in_estimates(double n_modes) const
{
  constexpr double arrays = 4.0, widest_product = 16.0, most_pairs = 100.0;
  const double kept = options_.count.value_or(false) ? std::min(n_modes, most_pairs) : 0.0;
  const double workspace = 2.0 * std::min(columns_at_a_time_, widest_product);
  return arrays * columns_at_a_time_ + workspace + kept;
}

/// Of block Lanczos, of the length of all slaves: the most that parts take is where all modes are
/// those of the largest.
double MemoryForecast::basis_columns(double n_modes) const
{
  constexpr double basis_for_each_mode = 2.2, least_basis = 85.0;
  return std::min(largest_part_ * basis_for_each_mode * n_modes + least_basis, n_slaves_);
}

/// While modes are sought, with the constraint modes where they come first.
double MemoryForecast::columns_in_search(double n_modes) const
{
  constexpr double blocks_of_lanczos = 16.0;
  if (n_modes == 0.0) return 0.0;
  const bool is_free = has_free_masters(options_.basis.method);
  const double Psi = part_of_Psi_ * n_masters_;
  const double there = options_.basis.tolerance || is_free ? Psi : 0.0;  // Psi comes first
  const double copied_Psi = largest_part_ < 1.0 && is_free ? largest_part_ * n_masters_ : 0.0;
  const double modes_of_part = largest_part_ < 1.0 ? largest_part_ * n_modes : 0.0;
  const double large = there + basis_columns(n_modes) + largest_part_ * n_modes + modes_of_part;
  return in_memory_ * large + copied_Psi + blocks_of_lanczos;
}

double MemoryForecast::beside_MiB(double n_modes) const
{
  n_modes = std::min(n_modes, n_slaves_);
  const double kept = n_masters_ + n_modes;
  const double Psi = in_memory_ * part_of_Psi_ * n_masters_;
  const double Phi =
      has_free_masters(options_.basis.method) ? n_modes : in_memory_ * largest_part_ * n_modes;
  const WorkAfterwards& later = options_.later;
  const double for_each =
      later.columns_for_each_kept + largest_part_ * later.of_a_part_for_each_kept;
  const double later_MiB =
      column_MiB_ * (later.columns + for_each * kept) + M_MiB_ * later.matrices;
  constexpr double panels_of_constraint_modes = 32.0;
  const double least_work = std::max(columns_in_estimates(n_modes), panels_of_constraint_modes);
  return std::max(column_MiB_ * columns_in_search(n_modes) + mass_of_parts_ +
                      (options_.basis.tolerance ? trials_MiB(kept) : 0.0),
                  column_MiB_ * (Psi + Phi) + std::max(column_MiB_ * least_work, later_MiB)) -
         let_go_MiB_;
}

linear::SecondFactor MemoryForecast::second(double n_modes) const
{
  if (!options_.count.value_or(false)) return {};
  return {
      .entries = entries_of_counting_factor,
      // K - sigma M, of it the rows that are counted, and the graphs of their order
      .beside_MiB = in_memory_ * column_MiB_ *
                        (part_of_Psi_ * n_masters_ + largest_part_ * std::min(n_modes, n_slaves_)) +
                    3.0 * K_MiB_};
}

linear::FactorOptions MemoryForecast::at_first(linear::FactorOptions factor) const
{
  const double n_modes = modes_at_first(options_.basis);
  factor.beside_MiB = beside_MiB(n_modes);
  factor.second = second(n_modes);
  factor.is_least = grows(options_.basis);
  return factor;
}

void MemoryForecast::require(Mat factor, PetscInt n_modes) const
{
  if (!grows(options_.basis)) return;  // all of them were asked about before
  linear::set_beside(factor, beside_MiB(n_modes), second(n_modes));
  const linear::MemoryNeed need = linear::memory_need(factor);
  if (need.fits()) return;
  throw Error(fmt::format(
      "fixed_interface_modes: the search goes on to {} modes; with the factor of K_ss and the "
      "memory beside it they need {:.0f} MiB on one machine, where {:.0f} MiB were free; use more "
      "machines, a coarser mesh or fewer masters, lower the range, raise the tolerance, give "
      "-cms_scratch or raise -cms_memory",
      n_modes, need.needed_MiB, need.free_MiB));
}

}  // namespace chladni::reduce
