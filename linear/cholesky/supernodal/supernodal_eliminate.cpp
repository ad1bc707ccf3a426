// The elimination of a SupernodalFactor.
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
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
  const GatheredRows rows(A, is_needed);
  Fronts fronts(tree_, rows.rows());
  int n_negative = 0;
  for (const bool is_shared : {false, true}) {
    const int n = is_shared ? eliminate_shared(fronts, visit)
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
    visit(fronts, s);
  }
  return n_negative;
}

/// What the children that belong to some of the ranks of a group left on the first of them.
void SupernodalFactor::take_left_overs(Fronts& fronts, int s) const
{
  const int level = level_of(s);
  std::vector<double> triangle;
  for (const int child : fronts.children(s)) {
    if (group_[child] == group_[s]) continue;
    const std::size_t n = tree_.below(child).size();
    triangle.resize(n * (n + 1) / 2);
    double* values = fronts.left_over(child);
    const auto for_columns = [&](const auto& move) {
      for (std::size_t j = 0, at = 0; j < n; at += n - j++) move(values + j * (n + 1), at, n - j);
    };
    const int from = group_[child].first;
    if (rank_ == from) {
      for_columns([&](const double* column, std::size_t at, std::size_t length) {
        std::copy_n(column, length, triangle.begin() + std::ptrdiff_t(at));
      });
    }
    broadcast_numbers(triangle, from - group_[s].first, group_comms_[level]);
    if (rank_ == from) continue;
    for_columns([&](double* column, std::size_t at, std::size_t length) {
      std::copy_n(triangle.begin() + std::ptrdiff_t(at), length, column);
    });
  }
}

/// By all ranks of a group alike. Where one fails the others know nothing of it: it goes on with
/// what it has, so that nobody waits for ever.
/// @return negative pivots of those groups whose first rank this is, -1 where a pivot vanishes
int SupernodalFactor::eliminate_shared(Fronts& fronts, const Visit& visit) const
{
  int n_negative = 0;
  bool has_failed = false;
  std::exception_ptr complaint;
  for (const std::vector<int>& supernodes : whole_.supernodes.shared) {
    for (const int s : supernodes) {
      take_left_overs(fronts, s);
      int n = -1;
      try {
        n = fronts.eliminate(s);
      } catch (...) {
        complaint = std::current_exception();
      }
      has_failed = has_failed || n < 0;
      if (n > 0 && is_counted_here(s)) n_negative += n;
      if (n >= 0) visit(fronts, s);
    }
  }
  return on_all_ranks(comm_, [&] {
    if (complaint) std::rethrow_exception(complaint);
    return has_failed ? -1 : n_negative;
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

PivotSigns SupernodalFactor::pivot_signs(Mat A, Vec size_of_diagonal) const
{
  const LogEvent event(Event::factorization);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> sums(tree_.row.size(), 0.0);
  const Eliminated all = eliminate(A, [&](const Fronts& fronts, int s) {
    if (is_counted_here(s)) add_squares(fronts, s, sums);
  });
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
