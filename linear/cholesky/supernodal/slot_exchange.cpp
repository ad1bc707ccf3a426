#include "linear/cholesky/supernodal/slot_exchange.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "linear/cholesky/supernodal/subtrees.hpp"
#include "linear/kernels/gather.hpp"
#include "linear/kernels/tile_kernels.hpp"

namespace chladni::linear {

namespace {

/// Columns first to first + n of some rows, eight numbers for each row, filled up with zeros.
void pack(LocalColumns X, PetscInt first, const std::vector<int>& rows, double* to)
{
  const PetscInt n = std::min<PetscInt>(panel_width, X.n_columns - first);
  const double* from = X.values + std::size_t(first) * X.leading_dimension;
  for (const int row : rows) {
    for (PetscInt c = 0; c < n; ++c) to[c] = from[row + std::size_t(c) * X.leading_dimension];
    for (PetscInt c = n; c < panel_width; ++c) to[c] = 0.0;
    to += panel_width;
  }
}

/// @param columns  of X, at most as many as a panel has
void unpack(const double* from, std::span<const int> columns, const std::vector<int>& rows,
            LocalColumns X)
{
  std::array<double*, panel_width> to{};
  for (std::size_t c = 0; c < columns.size(); ++c)
    to[c] = X.values + std::size_t(columns[c]) * X.leading_dimension;
  for (const int row : rows) {
    for (std::size_t c = 0; c < columns.size(); ++c) to[c][row] = from[c];
    from += panel_width;
  }
}

void put(const double* from, const std::vector<int>& slots, double* panel)
{
  for (std::size_t i = 0; i < slots.size(); ++i)
    std::copy_n(from + i * panel_width, panel_width, panel + std::size_t(slots[i]) * panel_width);
}

void get(const double* panel, const std::vector<int>& slots, double* to)
{
  for (std::size_t i = 0; i < slots.size(); ++i)
    std::copy_n(panel + std::size_t(slots[i]) * panel_width, panel_width, to + i * panel_width);
}

}  // namespace

SlotExchange::SlotExchange(const RowRange& here, const std::vector<int>& owner,
                           const std::vector<int>& slot)
    : comm_(here.comm)
{
  const PetscInt first = here.first, last = here.last;
  const int n_ranks = petsc::size(comm_);
  std::vector<std::vector<int>> rows_of_rank(n_ranks);
  for (PetscInt row = first; row < last; ++row) {
    if (owner[row] != all_ranks) {
      rows_of_rank[owner[row]].push_back(row);
    } else {
      common_rows_.push_back(row - first);
      common_slots_.push_back(slot[row]);
    }
  }
  for (std::size_t row = 0; row < owner.size(); ++row) {
    const bool is_elsewhere = std::cmp_less(row, first) || std::cmp_greater_equal(row, last);
    if (owner[row] == all_ranks && is_elsewhere) other_common_slots_.push_back(slot[row]);
  }
  slot_counts_.resize(n_ranks);
  for (const std::vector<int>& rows : rows_of_rank) {
    row_counts_.push_back(static_cast<int>(rows.size()));
    rows_.insert(rows_.end(), rows.begin(), rows.end());
  }
  // In the order of slots a single rank has nothing left to do where these stand side by side.
  if (n_ranks == 1) std::ranges::sort(rows_, {}, [&](int row) { return slot[row]; });
  MPI_Alltoall(row_counts_.data(), 1, MPI_INT, slot_counts_.data(), 1, MPI_INT, comm_);
  row_starts_ = offsets(row_counts_);
  slot_starts_ = offsets(slot_counts_);
  slots_.resize(slot_starts_.back());
  MPI_Alltoallv(rows_.data(), row_counts_.data(), row_starts_.data(), MPI_INT, slots_.data(),
                slot_counts_.data(), slot_starts_.data(), MPI_INT, comm_);
  for (int& row : slots_) row = slot[row];
  for (int& row : rows_) row -= first;
  const auto n = std::ssize(slots_);
  stands_in_place_ = n_ranks == 1 && n > 0 && slots_.back() - slots_.front() == n - 1;
}

double* SlotExchange::place_in(double* panel) const
{
  return panel + std::size_t(slots_.front()) * panel_width;
}

void SlotExchange::to_slots(LocalColumns X, PetscInt first, Panels panels) const
{
  const RowType row_of_panel(panel_width);
  std::vector<double> out(stands_in_place_ ? 0 : rows_.size() * panel_width),
      in(stands_in_place_ ? 0 : slots_.size() * panel_width),
      common(common_rows_.size() * panel_width);
  for (int p = 0; p < panels.n_panels; ++p, first += panel_width) {
    double* panel = panels.values + p * panels.stride;
    pack(X, first, rows_, stands_in_place_ ? place_in(panel) : out.data());
    if (stands_in_place_) continue;
    MPI_Alltoallv(out.data(), row_counts_.data(), row_starts_.data(), row_of_panel, in.data(),
                  slot_counts_.data(), slot_starts_.data(), row_of_panel, comm_);
    put(in.data(), slots_, panel);
    pack(X, first, common_rows_, common.data());
    put(common.data(), common_slots_, panel);
    for (const int slot : other_common_slots_)
      std::fill_n(panel + std::size_t(slot) * panel_width, panel_width, 0.0);
  }
}

void SlotExchange::to_rows(Panels panels, std::span<const int> columns, LocalColumns X) const
{
  const RowType row_of_panel(panel_width);
  std::vector<double> in(stands_in_place_ ? 0 : rows_.size() * panel_width),
      out(stands_in_place_ ? 0 : slots_.size() * panel_width),
      common(common_rows_.size() * panel_width);
  for (int p = 0; p < panels.n_panels; ++p) {
    double* panel = panels.values + p * panels.stride;
    const std::size_t first = std::size_t(p) * panel_width;
    const auto some =
        columns.subspan(first, std::min<std::size_t>(panel_width, columns.size() - first));
    if (!stands_in_place_) {
      get(panel, slots_, out.data());
      MPI_Alltoallv(out.data(), slot_counts_.data(), slot_starts_.data(), row_of_panel, in.data(),
                    row_counts_.data(), row_starts_.data(), row_of_panel, comm_);
      get(panel, common_slots_, common.data());
      unpack(common.data(), some, common_rows_, X);
    }
    unpack(stands_in_place_ ? place_in(panel) : in.data(), some, rows_, X);
  }
}

}  // namespace chladni::linear
