#include "linear/cholesky/supernodal/supernodal_factor.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/all_ranks.hpp"
#include "linear/cholesky/elimination_order.hpp"
#include "linear/cholesky/supernodal/gathered_rows.hpp"
#include "linear/cholesky/supernodal/subtrees.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/tile_kernels.hpp"
#include "linear/log_event.hpp"

namespace chladni::linear {

SupernodalFactor::SupernodalFactor(MPI_Comm comm)
{
  MPI_Comm_dup(comm, &comm_);
  rank_ = petsc::rank(comm_);
}

SupernodalFactor::~SupernodalFactor()
{
  MPI_Comm_free(&comm_);
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
  const LogEvent event(Event::analysis);
  tiles_.reset();  // of another matrix
  panel_values_.reset();
  error_ = MAT_FACTOR_NOERROR;
  n_negative_ = 0;
  tree_ = assembly_tree(quotient_graph(A), places);
  owner_ = share_subtrees(tree_, petsc::size(comm_));
  number_trees();
  whole_.supernodes = of_trees(std::vector<char>(tree_.n_supernodes(), 1));
  number_slots();
  RowRange here{.comm = comm_, .first = 0, .last = 0};
  petsc::check(MatGetOwnershipRange(A, &here.first, &here.last));
  std::vector<int> rows(n);
  std::iota(rows.begin(), rows.end(), 0);
  whole_.exchange = exchange_of(rows, here);
  MatInfo info{};
  petsc::check(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  n_gathered_ = petsc::size(comm_) == 1 ? 0.0 : info.nz_used * n_slots_ / n;
}

/// Own supernodes first, then those of all ranks.
void SupernodalFactor::number_slots()
{
  slot_.assign(tree_.row.size(), -1);
  tile_starts_.assign(tree_.n_supernodes() + 1, 0);
  n_slots_ = 0;
  for (const std::vector<int>* supernodes : {&whole_.supernodes.own, &whole_.supernodes.common}) {
    for (const int s : *supernodes) {
      for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p) slot_[p] = n_slots_++;
      tile_starts_[s + 1] = tiled_size(tree_.n_columns(s), static_cast<int>(tree_.below(s).size()));
    }
    if (supernodes == &whole_.supernodes.own) n_own_slots_ = n_slots_;
  }
  std::inclusive_scan(tile_starts_.begin(), tile_starts_.end(), tile_starts_.begin());
  below_slots_.clear();
  for (const int position : tree_.below_rows) below_slots_.push_back(slot_[position]);
}

FactorSize SupernodalFactor::size() const
{
  FactorSize size{.operations = 0.0, .entries = 0.0};
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    size.operations += tree_.n_operations(s);
    size.entries += tree_.n_entries(s);
  }
  return size;
}

CholeskyFactor::Memory SupernodalFactor::forecast() const
{
  const std::vector<int>& common = whole_.supernodes.common;
  double front = 0.0;
  for (const std::vector<int>* supernodes : {&whole_.supernodes.own, &common}) {
    for (const int s : *supernodes) {
      const double w = tree_.n_columns(s);
      front = std::max(front, w * (w + double(tree_.below(s).size())));
    }
  }
  std::vector<int> all = whole_.supernodes.own;
  all.insert(all.end(), common.begin(), common.end());
  constexpr double numbers_in_MiB = bytes_in_MiB / sizeof(double);
  const auto kept = double(tile_starts_.back());
  const double work = 2.0 * front + peak_of_left_overs(tree_, all);  // L and L D of the front
  const double gathered = n_gathered_ * (1.0 + 0.5);                 // with its index
  return {.factorization_MiB = (kept + work + gathered) / numbers_in_MiB,
          .factor_MiB = (kept + double(n_slots_) * most_columns) / numbers_in_MiB,
          .entries_MiB = kept / numbers_in_MiB};
}

std::string SupernodalFactor::description() const
{
  const FactorSize all = size();
  double common = 0.0;
  for (const int s : whole_.supernodes.common) common += tree_.n_entries(s);
  return fmt::format(
      "supernodal, ordering by METIS: {:.3g} operations, {:.3g} entries in {} supernodes, "
      "{:.0f} % of them on all ranks",
      all.operations, all.entries, tree_.n_supernodes(),
      100.0 * common / std::max(all.entries, 1.0));
}

void SupernodalFactor::factorize(Mat A)
{
  const LogEvent event(Event::factorization);
  if (!tiles_) tiles_ = aligned_numbers(tile_starts_.back());
  eliminate(A, [this](const Fronts& fronts, int s) { keep(fronts, s); });
}

/// Pivots of one sign, positive or negative, need no choice.
bool SupernodalFactor::is_reliable() const
{
  if (error_ == MAT_FACTOR_NUMERIC_ZEROPIVOT) return false;
  return n_negative_ == 0 || std::cmp_equal(n_negative_, tree_.row.size());
}

void SupernodalFactor::keep(const Fronts& fronts, int s)
{
  store_tiles(fronts.columns(), tree_.n_columns(s), static_cast<int>(tree_.below(s).size()),
              tiles_.get() + tile_starts_[s]);
}

void SupernodalFactor::eliminate(Mat A, const Visit& visit)
{
  std::vector<char> is_needed(tree_.row.size());
  for (std::size_t p = 0; p < slot_.size(); ++p) is_needed[tree_.row[p]] = slot_[p] != -1;
  const GatheredRows rows(A, is_needed);
  Fronts fronts(tree_, rows.rows());
  error_ = MAT_FACTOR_NUMERIC_ZEROPIVOT;
  n_negative_ = 0;
  int n_negative = on_all_ranks(comm_, [&] { return eliminate_own(fronts, visit); });
  int n_failed = n_negative < 0 ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &n_failed, 1, MPI_INT, MPI_SUM, comm_);
  MPI_Allreduce(MPI_IN_PLACE, &n_negative, 1, MPI_INT, MPI_SUM, comm_);
  if (n_failed > 0) return;
  for (const int s : whole_.supernodes.common) {
    const int n = eliminate_common(fronts, s, visit);
    if (n < 0) return;
    n_negative += n;
  }
  n_negative_ = n_negative;
  error_ = MAT_FACTOR_NOERROR;
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

/// On all ranks alike, with what the children left on one of them.
int SupernodalFactor::eliminate_common(Fronts& fronts, int s, const Visit& visit) const
{
  for (int child = 0; child < s; ++child) {
    if (tree_.parent[child] != s || owner_[child] == all_ranks) continue;
    const std::size_t n = tree_.below(child).size();
    double* values = fronts.left_over(child);
    for (std::size_t j = 0; j < n; ++j)
      MPI_Bcast(values + j * n, static_cast<int>(n), MPI_DOUBLE, owner_[child], comm_);
  }
  const int n_negative = fronts.eliminate(s);
  if (n_negative >= 0) visit(fronts, s);
  return n_negative;
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

PivotSigns SupernodalFactor::pivot_signs(Mat A, Vec size_of_diagonal)
{
  const LogEvent event(Event::factorization);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> sums(tree_.row.size(), 0.0);
  eliminate(A, [&](const Fronts& fronts, int s) {
    const bool is_others = owner_[s] == all_ranks && rank_ != 0;
    if (!is_others) add_squares(fronts, s, sums);
  });
  if (error_ != MAT_FACTOR_NOERROR) return {.n_negative = 0, .growth = infinite};
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
  return {.n_negative = n_negative_, .growth = std::isfinite(growth) ? growth : infinite};
}

}  // namespace chladni::linear
