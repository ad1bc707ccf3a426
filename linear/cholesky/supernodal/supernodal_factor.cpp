#include "linear/cholesky/supernodal/supernodal_factor.hpp"

#include <algorithm>
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

namespace {

int n_panels(PetscInt n_columns)
{
  return (n_columns + panel_width - 1) / panel_width;
}

}  // namespace

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
  own_.clear();
  common_.clear();
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    if (owner_[s] == rank_) own_.push_back(s);
    if (owner_[s] == all_ranks) common_.push_back(s);
  }
  number_slots();
  std::vector<int> owner_of_row(n), slot_of_row(n);
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p) {
      owner_of_row[tree_.row[p]] = owner_[s];
      slot_of_row[tree_.row[p]] = slot_[p];
    }
  }
  exchange_ = SlotExchange(A, owner_of_row, slot_of_row);
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
  for (const std::vector<int>* supernodes : {&own_, &common_}) {
    for (const int s : *supernodes) {
      for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p) slot_[p] = n_slots_++;
      tile_starts_[s + 1] = tiled_size(tree_.n_columns(s), static_cast<int>(tree_.below(s).size()));
    }
    if (supernodes == &own_) n_own_slots_ = n_slots_;
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
  double front = 0.0;
  for (const std::vector<int>* supernodes : {&own_, &common_}) {
    for (const int s : *supernodes) {
      const double w = tree_.n_columns(s);
      front = std::max(front, w * (w + double(tree_.below(s).size())));
    }
  }
  std::vector<int> all = own_;
  all.insert(all.end(), common_.begin(), common_.end());
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
  for (const int s : common_) common += tree_.n_entries(s);
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
  eliminate(A);
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

void SupernodalFactor::eliminate(Mat A)
{
  std::vector<char> is_needed(tree_.row.size());
  for (std::size_t p = 0; p < slot_.size(); ++p) is_needed[tree_.row[p]] = slot_[p] != -1;
  const GatheredRows rows(A, is_needed);
  Fronts fronts(tree_, rows.rows());
  error_ = MAT_FACTOR_NUMERIC_ZEROPIVOT;
  n_negative_ = 0;
  int n_negative = on_all_ranks(comm_, [&] { return eliminate_own(fronts); });
  int n_failed = n_negative < 0 ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &n_failed, 1, MPI_INT, MPI_SUM, comm_);
  MPI_Allreduce(MPI_IN_PLACE, &n_negative, 1, MPI_INT, MPI_SUM, comm_);
  if (n_failed > 0) return;
  for (const int s : common_) {
    const int n = eliminate_common(fronts, s);
    if (n < 0) return;
    n_negative += n;
  }
  n_negative_ = n_negative;
  error_ = MAT_FACTOR_NOERROR;
}

/// The number of negative pivots, -1 where one vanishes.
int SupernodalFactor::eliminate_own(Fronts& fronts)
{
  int n_negative = 0;
  for (const int s : own_) {
    const int n = fronts.eliminate(s);
    if (n < 0) return -1;
    n_negative += n;
    keep(fronts, s);
  }
  return n_negative;
}

/// On all ranks alike, with what the children left on one of them.
int SupernodalFactor::eliminate_common(Fronts& fronts, int s)
{
  for (int child = 0; child < s; ++child) {
    if (tree_.parent[child] != s || owner_[child] == all_ranks) continue;
    const std::size_t n = tree_.below(child).size();
    double* values = fronts.left_over(child);
    for (std::size_t j = 0; j < n; ++j)
      MPI_Bcast(values + j * n, static_cast<int>(n), MPI_DOUBLE, owner_[child], comm_);
  }
  const int n_negative = fronts.eliminate(s);
  if (n_negative >= 0) keep(fronts, s);
  return n_negative;
}

TiledColumns SupernodalFactor::tiles(int s) const
{
  const std::size_t first = tree_.below_starts[s], n = tree_.below_starts[s + 1] - first;
  return {.values = tiles_.get() + tile_starts_[s],
          .n_columns = tree_.n_columns(s),
          .first = slot_[tree_.first_column[s]],
          .below = std::span(below_slots_).subspan(first, n)};
}

Panels SupernodalFactor::panels(int n_columns)
{
  const std::size_t stride = std::size_t(n_slots_) * panel_width;
  if (!panel_values_) panel_values_ = aligned_numbers(stride * n_panels(most_columns));
  return {.values = panel_values_.get(), .stride = stride, .n_panels = n_panels(n_columns)};
}

/// X <- A^-1 X; forward only where right-hand sides are not zero.
void SupernodalFactor::sweep(Panels X, const std::vector<char>& is_active) const
{
  for (const int s : own_)
    if (is_active[s] != 0) solve_forward(tiles(s), X);
  const auto n_common = std::size_t(n_slots_ - n_own_slots_) * panel_width;
  for (int p = 0; p < X.n_panels && n_common > 0; ++p) {
    double* common = X.values + p * X.stride + std::size_t(n_own_slots_) * panel_width;
    sum_over_ranks(std::span(common, n_common), comm_);
  }
  for (const int s : common_) solve_forward(tiles(s), X);
  for (auto s = common_.rbegin(); s != common_.rend(); ++s) solve_backward(tiles(*s), X);
  for (auto s = own_.rbegin(); s != own_.rend(); ++s) solve_backward(tiles(*s), X);
}

void SupernodalFactor::solve(LocalColumns X)
{
  const LogEvent event(Event::solution);
  const std::vector<char> all(tree_.n_supernodes(), 1);
  for (PetscInt first = 0; first < X.n_columns; first += most_columns) {
    const Panels block = panels(std::min(most_columns, X.n_columns - first));
    exchange_.to_slots(X, first, block);
    sweep(block, all);
    exchange_.to_rows(block, first, X);
  }
}

/// Columns from `first` on; the supernodes where they are not zero, and those above.
std::vector<char> SupernodalFactor::take(const SparseColumns& B, int first, Panels block) const
{
  const int last = std::min(first + block.n_panels * panel_width, B.n_columns);
  std::fill_n(block.values, block.stride * block.n_panels, 0.0);
  std::vector<char> is_active(tree_.n_supernodes(), 0);
  for (int j = first; j < last; ++j) {
    const std::size_t panel = (j - first) / panel_width, column = (j - first) % panel_width;
    for (int k = B.starts[j]; k < B.starts[j + 1]; ++k) {
      const int p = tree_.position[B.rows[k]];
      const bool is_common = slot_[p] >= n_own_slots_;
      if (slot_[p] == -1 || (is_common && rank_ != 0)) continue;
      block.values[panel * block.stride + std::size_t(slot_[p]) * panel_width + column] =
          B.values[k];
      const auto behind = std::ranges::upper_bound(tree_.first_column, p);
      is_active[behind - tree_.first_column.begin() - 1] = 1;
    }
  }
  for (int s = 0; s < tree_.n_supernodes(); ++s)
    if (is_active[s] != 0 && tree_.parent[s] != -1) is_active[tree_.parent[s]] = 1;
  return is_active;
}

void SupernodalFactor::solve(const SparseColumns& on_first_rank, LocalColumns X)
{
  const LogEvent event(Event::solution);
  SparseColumns B = on_first_rank;
  int n_entries = static_cast<int>(B.values.size());
  MPI_Bcast(&n_entries, 1, MPI_INT, 0, comm_);
  B.starts.resize(B.n_columns + 1);
  B.rows.resize(n_entries);
  B.values.resize(n_entries);
  MPI_Bcast(B.starts.data(), B.n_columns + 1, MPI_INT, 0, comm_);
  MPI_Bcast(B.rows.data(), n_entries, MPI_INT, 0, comm_);
  MPI_Bcast(B.values.data(), n_entries, MPI_DOUBLE, 0, comm_);
  for (int first = 0; first < B.n_columns; first += most_columns) {
    const Panels block = panels(std::min<int>(most_columns, B.n_columns - first));
    const std::vector<char> is_active = take(B, first, block);
    sweep(block, is_active);
    exchange_.to_rows(block, first, X);
  }
}

}  // namespace chladni::linear
