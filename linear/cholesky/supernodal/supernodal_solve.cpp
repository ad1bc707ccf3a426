// The solutions of a SupernodalFactor.

#include "linear/cholesky/supernodal/supernodal_factor.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/panel_kernels.hpp"
#include "linear/log_event.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

namespace {

int n_panels(std::size_t n_columns)
{
  return static_cast<int>((n_columns + panel_width - 1) / panel_width);
}

/// Those from rank 0, on all ranks.
SparseColumns on_all(SparseColumns B, MPI_Comm comm)
{
  int n_entries = static_cast<int>(B.values.size());
  MPI_Bcast(&n_entries, 1, MPI_INT, 0, comm);
  B.starts.resize(B.n_columns + 1);
  B.rows.resize(n_entries);
  B.values.resize(n_entries);
  MPI_Bcast(B.starts.data(), B.n_columns + 1, MPI_INT, 0, comm);
  MPI_Bcast(B.rows.data(), n_entries, MPI_INT, 0, comm);
  MPI_Bcast(B.values.data(), n_entries, MPI_DOUBLE, 0, comm);
  return B;
}

/// A block of columns ends when it is full, or has a panel and the next one lies in other trees.
bool is_complete(const std::vector<int>& block, PetscInt most, bool next_is_alike)
{
  return std::ssize(block) == most || (std::ssize(block) >= panel_width && !next_is_alike);
}

}  // namespace

std::span<const int> SupernodalFactor::below_slots(int s) const
{
  const std::size_t first = tree_.below_starts[s], n = tree_.below_starts[s + 1] - first;
  return std::span(below_slots_).subspan(first, n);
}

TiledColumns SupernodalFactor::tiles(int s) const
{
  return {.values = tiles_.get() + tile_starts_[s],
          .n_columns = tree_.n_columns(s),
          .first = slot_[tree_.first_column[s]],
          .below = below_slots(s)};
}

SharedColumns SupernodalFactor::shared_columns(int s) const
{
  return {.values = tiles_.get() + tile_starts_[s],
          .rows = dealt_rows(s),
          .place = rank_ - group_[s].first,
          .first = slot_[tree_.first_column[s]],
          .below = below_slots(s)};
}

Panels SupernodalFactor::panels(std::size_t n_columns)
{
  const std::size_t stride = std::size_t(n_slots_) * panel_width;
  if (!panel_values_) panel_values_ = aligned_numbers(stride * n_panels(most_columns));
  return {.values = panel_values_.get(), .stride = stride, .n_panels = n_panels(n_columns)};
}

/// Sums the slots of the columns of s over its group.
void SupernodalFactor::sum_slots(int s, Panels X) const
{
  const MPI_Comm comm = group_comms_[level_of(s)];
  double* first = X.values + std::size_t(slot_[tree_.first_column[s]]) * panel_width;
  const std::size_t n = std::size_t(tree_.n_columns(s)) * panel_width;
  if (X.n_panels == 1) return sum_over_ranks(std::span(first, n), comm);
  std::vector<double> all(n * X.n_panels);
  for (int p = 0; p < X.n_panels; ++p)
    std::copy_n(first + p * X.stride, n, all.begin() + std::ptrdiff_t(p * n));
  sum_over_ranks(all, comm);
  for (int p = 0; p < X.n_panels; ++p)
    std::copy_n(all.begin() + std::ptrdiff_t(p * n), n, first + p * X.stride);
}

/// The own supernodes in whose slots or below them something is not zero, and all shared ones.
std::vector<char> SupernodalFactor::active_supernodes(Panels X, const Supernodes& trees) const
{
  std::vector<char> is_active(tree_.n_supernodes(), 1);
  for (const int s : trees.own) is_active[s] = 0;
  for (const int s : trees.own) {
    const std::size_t first = std::size_t(slot_[tree_.first_column[s]]) * panel_width;
    const std::size_t n = std::size_t(tree_.n_columns(s)) * panel_width;
    for (int p = 0; p < X.n_panels && is_active[s] == 0; ++p) {
      const std::span<const double> values(X.values + p * X.stride + first, n);
      if (std::ranges::any_of(values, [](double x) { return x != 0.0; })) is_active[s] = 1;
    }
    if (is_active[s] != 0 && tree_.parent[s] != -1) is_active[tree_.parent[s]] = 1;
  }
  return is_active;
}

/// X <- L^-1 X in some trees. Over the ranks of a group the slots above it add up to what all
/// supernodes below have put there. What comes out for shared rows stays with the rank that has
/// them.
/// @param is_active  [n_supernodes] right-hand sides are not zero; true of all shared ones
void SupernodalFactor::sweep_forward(Panels X, const Supernodes& trees,
                                     const std::vector<char>& is_active) const
{
  for (const int s : trees.own)
    if (is_active[s] != 0) solve_forward(tiles(s), X);
  for (const std::vector<int>& supernodes : trees.shared) {
    for (const int s : supernodes) {
      sum_slots(s, X);
      solve_forward(shared_columns(s), X);
    }
  }
}

/// X <- A^-1 X. Trees whose root is not active are zero.
void SupernodalFactor::sweep(Panels X, const Supernodes& trees,
                             const std::vector<char>& is_active) const
{
  sweep_forward(X, trees, is_active);
  const auto backwards = [](const auto& list, const auto& visit) {
    std::for_each(list.rbegin(), list.rend(), visit);
  };
  backwards(trees.shared, [&](const std::vector<int>& supernodes) {
    backwards(supernodes, [&](int s) {
      solve_backward(shared_columns(s), X);
      sum_slots(s, X);
    });
  });
  backwards(trees.own, [&](int s) {
    if (is_active[tree_of_[s]] != 0) solve_backward(tiles(s), X);
  });
}

/// X <- what `sweep` makes of it in panels, some columns at a time.
template <typename Sweep>
void SupernodalFactor::in_panels(const SlotExchange& exchange, LocalColumns X, const Sweep& sweep)
{
  const LogEvent event(Event::solution);
  std::vector<int> columns(X.n_columns);
  std::iota(columns.begin(), columns.end(), 0);
  for (PetscInt first = 0; first < X.n_columns; first += most_columns) {
    const PetscInt n = std::min(most_columns, X.n_columns - first);
    const Panels block = panels(n);
    exchange.to_slots(X, first, block);
    sweep(block);
    exchange.to_rows(block, std::span(columns).subspan(first, n), X);
  }
}

void SupernodalFactor::solve(const SupernodalPart& part, LocalColumns X)
{
  in_panels(part.exchange, X, [&](Panels block) {
    sweep(block, part.supernodes, active_supernodes(block, part.supernodes));
  });
}

void SupernodalFactor::solve_half(const SupernodalPart& part, LocalColumns X)
{
  in_panels(part.exchange, X, [&](Panels block) {
    sweep_forward(block, part.supernodes, active_supernodes(block, part.supernodes));
    for (const int s : part.supernodes.own) scale_by_root(tiles(s), block);
    for (const std::vector<int>& supernodes : part.supernodes.shared) {
      for (const int s : supernodes) {
        scale_by_root(shared_columns(s), block);
        sum_slots(s, block);
      }
    }
  });
}

/// The trees that each column is in: its roots, ascending.
std::vector<std::vector<int>> SupernodalFactor::trees_of(const SparseColumns& B) const
{
  std::vector<std::vector<int>> trees(B.n_columns);
  for (int j = 0; j < B.n_columns; ++j) {
    for (int k = B.starts[j]; k < B.starts[j + 1]; ++k)
      trees[j].push_back(tree_of_[supernode_of_row(B.rows[k])]);
    std::ranges::sort(trees[j]);
    trees[j].erase(std::unique(trees[j].begin(), trees[j].end()), trees[j].end());
  }
  return trees;
}

std::vector<int> SupernodalFactor::trees_of_own_rows() const
{
  std::vector<int> trees(std::size_t(last_row_ - first_row_));
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p) {
      const int row = tree_.row[p];
      if (row >= first_row_ && row < last_row_) trees[std::size_t(row - first_row_)] = tree_of_[s];
    }
  }
  return trees;
}

/// Some columns; the own supernodes where they are not zero, and those above, and all shared ones.
std::vector<char> SupernodalFactor::take(const SparseColumns& B, const std::vector<int>& columns,
                                         Panels block) const
{
  std::fill_n(block.values, block.stride * block.n_panels, 0.0);
  std::vector<char> is_active(tree_.n_supernodes(), 0);
  for (int s = 0; s < tree_.n_supernodes(); ++s)
    if (is_shared(s)) is_active[s] = 1;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    double* panel = block.values + j / panel_width * block.stride;
    for (int k = B.starts[columns[j]]; k < B.starts[columns[j] + 1]; ++k) {
      const int s = supernode_of_row(B.rows[k]);
      if (!is_counted_here(s)) continue;
      const int slot = slot_[tree_.position[B.rows[k]]];
      panel[std::size_t(slot) * panel_width + j % panel_width] = B.values[k];
      is_active[s] = 1;
    }
  }
  for (int s = 0; s < tree_.n_supernodes(); ++s)
    if (is_active[s] != 0 && tree_.parent[s] != -1) is_active[tree_.parent[s]] = 1;
  return is_active;
}

/// Columns in the same trees one after the other: the other trees have nothing to do for them.
void SupernodalFactor::solve(const SparseColumns& on_first_rank, LocalColumns X)
{
  const LogEvent event(Event::solution);
  SparseProblem problem{.B = on_all(on_first_rank, comm_), .trees = {}, .tree_of_row = {}};
  problem.trees = trees_of(problem.B);
  problem.tree_of_row = trees_of_own_rows();
  const int n_columns = problem.B.n_columns;
  const auto trees = [&](int j) -> const std::vector<int>& { return problem.trees[j]; };
  std::vector<int> order(n_columns), block;
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, trees);
  for (std::size_t i = 0; i < order.size(); ++i) {
    block.push_back(order[i]);
    const bool is_last = i + 1 == order.size();
    const bool next_is_alike = !is_last && trees(order[i]) == trees(order[i + 1]);
    if (!is_last && !is_complete(block, most_columns, next_is_alike)) continue;
    solve_block(problem, block, X);
    report_progress(double(i + 1) / n_columns);
    block.clear();
  }
  panel_values_.reset();  // later solutions touch fewer panels
}

void SupernodalFactor::solve_block(const SparseProblem& problem, const std::vector<int>& columns,
                                   LocalColumns X)
{
  std::vector<char> roots(tree_.n_supernodes(), 0), is_zero;
  for (const int j : columns)
    for (const int root : problem.trees[j]) roots[root] = 1;
  for (const int tree : problem.tree_of_row) is_zero.push_back(roots[tree] == 0 ? 1 : 0);
  const Panels block = panels(columns.size());
  const std::vector<char> is_active = take(problem.B, columns, block);
  sweep(block, of_trees(roots), is_active);
  whole_.exchange.to_rows(block, columns, X, is_zero);
}

// Trees of a SupernodalFactor, and rows that can be solved for without the others.

void SupernodalFactor::number_trees()
{
  tree_of_.assign(tree_.n_supernodes(), 0);
  for (int s = tree_.n_supernodes() - 1; s >= 0; --s)
    tree_of_[s] = tree_.parent[s] == -1 ? s : tree_of_[tree_.parent[s]];
}

int SupernodalFactor::supernode_at(int position) const
{
  const auto behind = std::ranges::upper_bound(tree_.first_column, position);
  return static_cast<int>(behind - tree_.first_column.begin()) - 1;
}

int SupernodalFactor::supernode_of_row(PetscInt row) const
{
  return supernode_at(tree_.position[row]);
}

Supernodes SupernodalFactor::of_trees(const std::vector<char>& roots) const
{
  Supernodes found{.own = {}, .shared = std::vector<std::vector<int>>(groups_.size())};
  for (int s = 0; s < tree_.n_supernodes(); ++s) {
    if (roots[tree_of_[s]] == 0 || !group_[s].has(rank_)) continue;
    (group_[s].size() == 1 ? found.own : found.shared[level_of(s)]).push_back(s);
  }
  return found;
}

SlotExchange SupernodalFactor::exchange_of(const std::vector<int>& own_rows,
                                           const Supernodes& supernodes) const
{
  RowSlots slots{.group = [&](int row) { return group_[supernode_of_row(row)]; },
                 .slot = [&](int row) { return slot_[tree_.position[row]]; },
                 .here = {}};
  const auto add = [&](const std::vector<int>& some) {
    for (const int s : some)
      for (int p = tree_.first_column[s]; p < tree_.first_column[s + 1]; ++p)
        slots.here.push_back(slot_[p]);
  };
  add(supernodes.own);
  std::ranges::for_each(supernodes.shared, add);
  return {comm_, own_rows, slots};
}

SupernodalPart SupernodalFactor::part(IS rows) const
{
  const std::vector<int> own = petsc::own_indices(rows);
  std::vector<char> roots(tree_.n_supernodes(), 0);
  for (const int row : own) roots[tree_of_[supernode_of_row(row)]] = 1;
  MPI_Allreduce(MPI_IN_PLACE, roots.data(), tree_.n_supernodes(), MPI_SIGNED_CHAR, MPI_MAX, comm_);
  auto n_rows = static_cast<int>(own.size());
  MPI_Allreduce(MPI_IN_PLACE, &n_rows, 1, MPI_INT, MPI_SUM, comm_);
  int n_coupled = 0;
  for (int s = 0; s < tree_.n_supernodes(); ++s)
    if (roots[tree_of_[s]] != 0) n_coupled += tree_.n_columns(s);
  if (n_coupled != n_rows) {
    throw Error(fmt::format(
        "SupernodalFactor::part: the {} rows of a part are coupled to {} others; take all of them",
        n_rows, n_coupled - n_rows));
  }
  SupernodalPart part{.supernodes = of_trees(roots), .exchange = {}};
  part.exchange = exchange_of(own, part.supernodes);
  return part;
}

}  // namespace chladni::linear
