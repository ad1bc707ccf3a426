// The elimination of a SupernodalFactor.
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <span>

#include "common/all_ranks.hpp"
#include "linear/cholesky/supernodal/gathered_rows.hpp"
#include "linear/cholesky/supernodal/supernodal_factor.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

SupernodalFactor::Eliminated SupernodalFactor::eliminate(Mat A, const Visit& visit) const
{
  std::vector<char> is_needed(tree_.row.size());
  for (std::size_t p = 0; p < slot_.size(); ++p) is_needed[tree_.row[p]] = slot_[p] != -1;
  const GatheredRows rows(A, is_needed, tree_.position);
  Fronts fronts(tree_, rows.rows());
  int n_negative = 0;
  for (const bool is_shared : {false, true}) {
    const int n = is_shared ? eliminate_shared(fronts, rows.rows(), visit)
                            : on_all_ranks(comm_, [&] { return eliminate_own(fronts, visit); });
    int n_failed = n < 0 ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &n_failed, 1, MPI_INT, MPI_SUM, comm_);
    if (n_failed > 0) return {.error = MAT_FACTOR_NUMERIC_ZEROPIVOT};
    n_negative += n;
  }
  MPI_Allreduce(MPI_IN_PLACE, &n_negative, 1, MPI_INT, MPI_SUM, comm_);
  return {.error = MAT_FACTOR_NOERROR, .n_negative = n_negative};
}

/// The number of negative pivots, -1 where one vanishes.
int SupernodalFactor::eliminate_own(Fronts& fronts, const Visit& visit) const
{
  int n_negative = 0;
  for (const int s : whole_.supernodes.own) {
    const int n = fronts.eliminate(s);
    if (n < 0) return -1;
    n_negative += n;
    visit.own(fronts, s);
  }
  return n_negative;
}

/// By the ranks of each group together. Where one fails those of its groups do nothing more, and
/// nobody waits for ever.
/// @return negative pivots of those groups whose first rank this is, -1 where a pivot vanishes
int SupernodalFactor::eliminate_shared(Fronts& fronts, const MatrixRows& A,
                                       const Visit& visit) const
{
  std::optional<SharedFronts> shared;
  on_all_ranks(comm_, [&] { return &shared.emplace(tree_, group_, fronts, rank_); });
  int n_negative = 0, has_failed = 0;
  std::exception_ptr complaint;
  for (std::size_t level = 0; level < groups_.size(); ++level) {
    for (const int s : whole_.supernodes.shared[level]) {
      try {
        if (has_failed == 0) shared->prepare(s, A);
      } catch (...) {
        complaint = std::current_exception();
        has_failed = 1;
      }
      MPI_Allreduce(MPI_IN_PLACE, &has_failed, 1, MPI_INT, MPI_MAX, group_comms_[level]);
      if (has_failed != 0) continue;
      const int n = shared->eliminate(s, group_comms_[level]);
      if (n > 0 && is_counted_here(s)) n_negative += n;
      try {
        if (n >= 0) visit.shared(shared->front(), s);
      } catch (...) {
        complaint = std::current_exception();
      }
      if (n < 0 || complaint) has_failed = 1;
    }
  }
  return on_all_ranks(comm_, [&] {
    if (complaint) std::rethrow_exception(complaint);
    return has_failed != 0 ? -1 : n_negative;
  });
}

/// Adds L_ij^2 |D_jj| of the columns of a supernode to the sums of their rows.
void SupernodalFactor::add_squares(const Fronts& fronts, int s, std::vector<double>& sums) const
{
  const std::span<const int> below = tree_.below(s);
  const int w = tree_.n_columns(s), first = tree_.first_column[s];
  const double* L = fronts.columns();
  for (int j = 0; j < w; ++j, L += std::size_t(w) + below.size()) {
    const double size = std::abs(L[j]);
    sums[tree_.row[first + j]] += size;
    for (int i = j + 1; i < w; ++i) sums[tree_.row[first + i]] += L[i] * L[i] * size;
    for (std::size_t i = 0; i < below.size(); ++i)
      sums[tree_.row[below[i]]] += L[w + i] * L[w + i] * size;
  }
}

/// The same for the rows of this rank.
void SupernodalFactor::add_own_squares(const DealtFront& front, int s,
                                       std::vector<double>& sums) const
{
  const std::span<const int> below = tree_.below(s);
  const int w = tree_.n_columns(s), first = tree_.first_column[s];
  const auto n_own = std::size_t(front.n_own());
  const double* L = front.L;
  front.rows.for_rows(front.place, 0, front.rows.n_rows(), [&](int row) {
    double& sum = sums[tree_.row[row < w ? first + row : below[row - w]]];
    for (int j = 0; j < std::min(row, w); ++j) {
      const double l = L[std::size_t(j) * n_own];
      sum += l * l * std::abs(front.D[j]);
    }
    if (row < w) sum += std::abs(front.D[row]);
    ++L;
  });
}

PivotSigns SupernodalFactor::pivot_signs(Mat A, Vec size_of_diagonal) const
{
  const LogEvent event(Event::factorization);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> sums(tree_.row.size(), 0.0);
  const Visit add{
      .own = [&](const Fronts& fronts, int s) { add_squares(fronts, s, sums); },
      .shared = [&](const DealtFront& front, int s) { add_own_squares(front, s, sums); }};
  const Eliminated all = eliminate(A, add);
  if (all.error != MAT_FACTOR_NOERROR) return {.n_negative = 0, .growth = infinite};
  sum_over_ranks(sums, comm_);
  PetscInt first = 0, last = 0;
  const PetscScalar* sizes = nullptr;
  petsc::check(VecGetOwnershipRange(size_of_diagonal, &first, &last));
  petsc::check(VecGetArrayRead(size_of_diagonal, &sizes));
  double growth = 0.0;
  for (PetscInt i = first; i < last; ++i)
    if (sums[i] > 0.0) growth = std::max(growth, sums[i] / std::max(sizes[i - first], 0.0));
  petsc::check(VecRestoreArrayRead(size_of_diagonal, &sizes));
  MPI_Allreduce(MPI_IN_PLACE, &growth, 1, MPI_DOUBLE, MPI_MAX, comm_);
  return {.n_negative = all.n_negative, .growth = std::isfinite(growth) ? growth : infinite};
}

}  // namespace chladni::linear
