#include "linear/cholesky/supernodal/slot_exchange.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "linear/kernels/gather.hpp"
#include "linear/kernels/tile_kernels.hpp"

namespace chladni::linear {

namespace {

/// Columns first to first + 7 of some rows into rows of a panel, filled up with zeros. Rows ascend,
/// so that columns are read as they stand in memory, and each row of the panel is one cache line.
/// @param slot  of each of the rows, by its number
template <typename Slot>
void pack(LocalColumns X, PetscInt first, const std::vector<int>& rows, const Slot& slot,
          double* panel)
{
  const PetscInt n = std::min<PetscInt>(panel_width, X.n_columns - first);
  const double* from = X.values + std::size_t(first) * X.leading_dimension;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double* to = panel + std::size_t(slot(i)) * panel_width;
    for (PetscInt c = 0; c < n; ++c) to[c] = from[rows[i] + std::size_t(c) * X.leading_dimension];
    for (PetscInt c = n; c < panel_width; ++c) to[c] = 0.0;
  }
}

/// @param columns  of X, at most as many as a panel has
template <typename Slot>
void unpack(const double* panel, const Slot& slot, std::span<const int> columns,
            const std::vector<int>& rows, LocalColumns X)
{
  std::array<double*, panel_width> to{};
  for (std::size_t c = 0; c < columns.size(); ++c)
    to[c] = X.values + std::size_t(columns[c]) * X.leading_dimension;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double* from = panel + std::size_t(slot(i)) * panel_width;
    for (std::size_t c = 0; c < columns.size(); ++c) to[c][rows[i]] = from[c];
  }
}

std::size_t same(std::size_t i)
{
  return i;
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

SlotExchange::SlotExchange(const RowRange& here, const std::vector<RowSlot>& rows)
    : comm_(here.comm)
{
  const int n_ranks = petsc::size(comm_), rank = petsc::rank(comm_);
  std::vector<std::vector<int>> rows_of_rank(n_ranks);
  for (PetscInt row = here.first; row < here.last; ++row) {
    const RankGroup& group = rows[row].group;
    rows_of_rank[group.has(rank) ? rank : group.first].push_back(row);
  }
  slot_counts_.resize(n_ranks);
  for (const std::vector<int>& some : rows_of_rank) {
    row_counts_.push_back(static_cast<int>(some.size()));
    rows_.insert(rows_.end(), some.begin(), some.end());
  }
  MPI_Alltoall(row_counts_.data(), 1, MPI_INT, slot_counts_.data(), 1, MPI_INT, comm_);
  row_starts_ = offsets(row_counts_);
  slot_starts_ = offsets(slot_counts_);
  slots_.resize(slot_starts_.back());
  MPI_Alltoallv(rows_.data(), row_counts_.data(), row_starts_.data(), MPI_INT, slots_.data(),
                slot_counts_.data(), slot_starts_.data(), MPI_INT, comm_);
  std::vector<char> is_got(rows.size(), 0);
  for (int& row : slots_) {
    is_got[row] = 1;
    row = rows[row].slot;
  }
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows[row].group.has(rank) && is_got[row] == 0) zero_slots_.push_back(rows[row].slot);
  for (int& row : rows_) row -= here.first;
}

void SlotExchange::to_slots(LocalColumns X, PetscInt first, Panels panels) const
{
  const auto own_slot = [&](std::size_t i) { return slots_[i]; };
  const bool is_alone = petsc::size(comm_) == 1;
  const RowType row_of_panel(panel_width);
  std::vector<double> out(is_alone ? 0 : rows_.size() * panel_width),
      in(is_alone ? 0 : slots_.size() * panel_width);
  for (int p = 0; p < panels.n_panels; ++p, first += panel_width) {
    double* panel = panels.values + p * panels.stride;
    if (is_alone) {
      pack(X, first, rows_, own_slot, panel);
      continue;
    }
    pack(X, first, rows_, same, out.data());
    MPI_Alltoallv(out.data(), row_counts_.data(), row_starts_.data(), row_of_panel, in.data(),
                  slot_counts_.data(), slot_starts_.data(), row_of_panel, comm_);
    put(in.data(), slots_, panel);
    for (const int slot : zero_slots_)
      std::fill_n(panel + std::size_t(slot) * panel_width, panel_width, 0.0);
  }
}

void SlotExchange::to_rows(Panels panels, std::span<const int> columns, LocalColumns X) const
{
  const auto own_slot = [&](std::size_t i) { return slots_[i]; };
  const bool is_alone = petsc::size(comm_) == 1;
  const RowType row_of_panel(panel_width);
  std::vector<double> in(is_alone ? 0 : rows_.size() * panel_width),
      out(is_alone ? 0 : slots_.size() * panel_width);
  for (int p = 0; p < panels.n_panels; ++p) {
    double* panel = panels.values + p * panels.stride;
    const std::size_t first = std::size_t(p) * panel_width;
    const auto some =
        columns.subspan(first, std::min<std::size_t>(panel_width, columns.size() - first));
    if (is_alone) {
      unpack(panel, own_slot, some, rows_, X);
      continue;
    }
    get(panel, slots_, out.data());
    MPI_Alltoallv(out.data(), slot_counts_.data(), slot_starts_.data(), row_of_panel, in.data(),
                  row_counts_.data(), row_starts_.data(), row_of_panel, comm_);
    unpack(in.data(), same, some, rows_, X);
  }
}

}  // namespace chladni::linear
