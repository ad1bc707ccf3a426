#include "linear/cholesky/supernodal/supernodal_factor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "common/all_ranks.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/cholesky/supernodal/rank_groups.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

SupernodalFactor::SupernodalFactor(MPI_Comm comm)
{
  MPI_Comm_dup(comm, &comm_);
  rank_ = petsc::rank(comm_);
}

SupernodalFactor::~SupernodalFactor()
{
  free_groups();
  MPI_Comm_free(&comm_);
}

void SupernodalFactor::free_groups()
{
  for (MPI_Comm& comm : group_comms_) MPI_Comm_free(&comm);
  group_comms_.clear();
  groups_.clear();
}

/// A communicator for each group of this rank, made by its ranks alone, the largest first.
void SupernodalFactor::make_groups()
{
  if (!group_comms_.empty()) return;
  groups_ = groups_of(rank_, petsc::size(comm_));
  group_comms_.resize(groups_.size());
  MPI_Group all = MPI_GROUP_NULL, some = MPI_GROUP_NULL;
  MPI_Comm_group(comm_, &all);
  for (std::size_t level = groups_.size(); level-- > 0;) {
    std::array<int, 3> range{groups_[level].first, groups_[level].last - 1, 1};
    MPI_Group_range_incl(all, 1, reinterpret_cast<int(*)[3]>(range.data()), &some);
    MPI_Comm_create_group(comm_, some, 0, &group_comms_[level]);
    MPI_Group_free(&some);
  }
  MPI_Group_free(&all);
}

/// The place of the group of a shared supernode among those of this rank.
int SupernodalFactor::level_of(int s) const
{
  return static_cast<int>(std::ranges::find(groups_, group_[s]) - groups_.begin());
}

void SupernodalFactor::analyze(Mat A)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(A, &n, nullptr));
  std::vector<int> places;
  {
    const LogEvent event(Event::ordering);
    places = elimination_order(A);
    places.resize(n);
    MPI_Bcast(places.data(), n, MPI_INT, 0, comm_);
  }
  analyze(A, places);
}

void SupernodalFactor::analyze(Mat A, const std::vector<int>& places)
{
  const LogEvent event(Event::analysis);
  const auto n = static_cast<int>(places.size());
  tiles_.reset();  // of another matrix
  panel_values_.reset();
  error_ = MAT_FACTOR_NOERROR;
  n_negative_ = 0;
  tree_ = assembly_tree(quotient_graph(A), places, [this](const AssemblyTree& tree) {
    group_ = share_subtrees(tree, petsc::size(comm_));
    return seen_by(rank_, tree, group_);
  });
  make_groups();
  number_trees();
  whole_.supernodes = of_trees(std::vector<char>(tree_.n_supernodes(), 1));
  number_slots();
  petsc::check(MatGetOwnershipRange(A, &first_row_, &last_row_));
  std::vector<int> rows(std::size_t(last_row_ - first_row_));
  std::iota(rows.begin(), rows.end(), first_row_);
  whole_.exchange = exchange_of(rows, whole_.supernodes);
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  n_entries_ = info.nz_used;
  n_gathered_ = petsc::size(comm_) == 1 ? 0.0 : n_entries_ * n_slots_ / n;
}

/// Own supernodes first, then the shared ones, those of the smallest group first.
void SupernodalFactor::number_slots()
{
  slot_.assign(tree_.row.size(), -1);
  tile_starts_.assign(tree_.n_supernodes() + 1, 0);
  n_slots_ = 0;
  const auto number = [&](const std::vector<int>& supernodes) {
    for (const int s : supernodes) {
      for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p) slot_[p] = n_slots_++;
      tile_starts_[s + 1] = is_shared(s) ? shared_size(dealt_rows(s), rank_ - group_[s].first)
                                         : tiled_size(tree_.n_columns(s), tree_.n_below[s]);
    }
  };
  number(whole_.supernodes.own);
  std::ranges::for_each(whole_.supernodes.shared, number);
  std::inclusive_scan(tile_starts_.begin(), tile_starts_.end(), tile_starts_.begin());
  below_slots_.clear();
  for (const int position : tree_.below_rows) below_slots_.push_back(slot_[position]);
}

FactorSize SupernodalFactor::size() const
{
  FactorSize size{.operations = 0.0, .entries = 0.0};
  const std::size_t n_ranks = petsc::size(comm_);
  std::vector<double> operations(n_ranks, 0.0), entries(n_ranks, 0.0);
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    size.operations += tree_.n_operations(s);
    size.entries += tree_.n_entries(s);
    for (int rank = group_[s].first; rank < group_[s].last; ++rank) {
      operations[rank] += operations_of_rank(tree_, s, group_[s].size());
      entries[rank] += entries_of_rank(tree_, s, group_[s], rank - group_[s].first);
    }
  }
  size.operations_of_rank = std::ranges::max(operations);
  size.entries_of_rank = std::ranges::max(entries);
  return size;
}

/// Numbers at the peak of the elimination besides the factor: columns of fronts, and update
/// matrices that wait for their parents.
double SupernodalFactor::peak_of_fronts() const
{
  double front = 0.0;  // L and L D; the largest one's memory is kept
  for (const int s : whole_.supernodes.own) {
    const double w = tree_.n_columns(s);
    front = std::max(front, 2.0 * w * (w + tree_.n_below[s]));
  }
  std::vector<double> of_children(tree_.n_supernodes(), 0.0);
  double waiting = 0.0, peak = peak_of_left_overs(tree_, whole_.supernodes.own);
  const auto wait = [&](int s) {
    const double m = tree_.n_below[s];
    const double left_over = m * m / group_[s].size();
    waiting += left_over;
    if (tree_.parent[s] != -1) of_children[tree_.parent[s]] += left_over;
  };
  for (const int s : whole_.supernodes.own) {
    wait(s);
    waiting -= of_children[s];
  }
  for (const std::vector<int>& supernodes : whole_.supernodes.shared) {
    for (const int s : supernodes) {
      const double w = tree_.n_columns(s), n = group_[s].size();
      const double m = tree_.n_below[s];
      const int place = rank_ - group_[s].first;
      const double moved = of_children[s];  // half of it sent, about as much received
      wait(s);
      peak = std::max(peak, waiting + moved + w * (w + m) / n + w * w +
                                double(size_of_workspace(dealt_rows(s), place)));
      waiting -= of_children[s];
    }
  }
  return front + peak;
}

CholeskyFactor::Memory SupernodalFactor::forecast() const
{
  constexpr double numbers_in_MiB = bytes_in_MiB / sizeof(double);
  const auto kept = double(tile_starts_.back());
  const double gathered = n_gathered_ * (1.0 + 0.5);  // with its index, and as sent
  return {.factorization_MiB = (kept + peak_of_fronts() + gathered) / numbers_in_MiB,
          .factor_MiB = (kept + double(n_slots_) * panel_width) / numbers_in_MiB,
          .entries_MiB = kept / numbers_in_MiB};
}

std::string SupernodalFactor::description() const
{
  const FactorSize all = size();
  return fmt::format(
      "supernodal, ordering by METIS: {:.3g} operations, {:.3g} entries in {} supernodes, at most "
      "{:.0f} % and {:.0f} % of them on one of {} ranks",
      all.operations, all.entries, tree_.n_supernodes(),
      100.0 * all.operations_of_rank / std::max(all.operations, 1.0),
      100.0 * all.entries_of_rank / std::max(all.entries, 1.0), petsc::size(comm_));
}

void SupernodalFactor::factorize(Mat A)
{
  const LogEvent event(Event::factorization);
  if (!tiles_) tiles_ = aligned_numbers(tile_starts_.back());
  error_ = MAT_FACTOR_NUMERIC_ZEROPIVOT;
  n_negative_ = 0;
  const Visit keep{.own =
                       [this](const Fronts& fronts, int s) {
                         store_tiles(fronts.columns(), tree_.n_columns(s), tree_.n_below[s],
                                     tiles_.get() + tile_starts_[s]);
                       },
                   .shared =
                       [this](const DealtFront& front, int s) {
                         divide_by_triangle(front);
                         store_shared(front.rows, front.place, front.L, front.D,
                                      tiles_.get() + tile_starts_[s]);
                       }};
  const Eliminated all = eliminate(A, keep);
  error_ = all.error;
  n_negative_ = all.n_negative;
}

/// Pivots of one sign, positive or negative, need no choice.
bool SupernodalFactor::is_reliable() const
{
  if (error_ == MAT_FACTOR_NUMERIC_ZEROPIVOT) return false;
  return n_negative_ == 0 || std::cmp_equal(n_negative_, tree_.row.size());
}

// The elimination of a SupernodalFactor.

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
