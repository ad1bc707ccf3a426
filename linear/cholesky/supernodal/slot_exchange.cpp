#include "linear/cholesky/supernodal/slot_exchange.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "linear/kernels/gather.hpp"
#include "linear/kernels/panel_kernels.hpp"

namespace chladni::linear {

namespace {

/// Columns first to first + 7, or those that there are, of some rows into rows of a panel.
void pack(LocalColumns X, PetscInt first, const PanelRows& rows, double* panel)
{
  std::array<const double*, panel_width> columns{};
  const auto n = std::min<std::size_t>(panel_width, std::size_t(X.n_columns - first));
  for (std::size_t c = 0; c < n; ++c)
    columns[c] = X.values + (std::size_t(first) + c) * std::size_t(X.leading_dimension);
  to_panel(std::span(columns).first(n), rows, panel_width, panel);
}

/// Some columns of X, which keeps memory that was never touched where rows are zero.
/// @param columns  at most as many as a panel has
void unpack(const double* panel, const PanelRows& rows, std::span<const int> columns,
            LocalColumns X, std::span<const char> is_zero)
{
  std::array<double*, panel_width> to{};
  for (std::size_t c = 0; c < columns.size(); ++c)
    to[c] = X.values + std::size_t(columns[c]) * std::size_t(X.leading_dimension);
  const std::span all = std::span(to).first(columns.size());
  if (is_zero.empty()) return to_columns(panel, panel_width, rows, all);
  const auto is_zero_at = [&](PetscInt i) { return is_zero[std::size_t(rows.rows[i])] != 0; };
  for (PetscInt i = 0; i < rows.n;) {
    PetscInt last = i + 1;
    while (last < rows.n && is_zero_at(last) == is_zero_at(i)) ++last;
    if (is_zero_at(i)) {
      for (PetscInt k = i; k < last; ++k)
        for (double* column : all)
          if (column[rows.rows[k]] != 0.0) column[rows.rows[k]] = 0.0;
    } else {
      const bool has_slots = rows.slots != nullptr;
      to_columns(
          has_slots ? panel : panel + std::size_t(i) * panel_width, panel_width,
          {.n = last - i, .rows = rows.rows + i, .slots = has_slots ? rows.slots + i : nullptr},
          all);
    }
    i = last;
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

SlotExchange::SlotExchange(MPI_Comm comm, const std::vector<int>& rows, const RowSlots& slots)
    : comm_(comm)
{
  const int n_ranks = petsc::size(comm_), rank = petsc::rank(comm_);
  std::vector<std::vector<int>> rows_of_rank(n_ranks);  // their places in X
  for (int i = 0; i < std::ssize(rows); ++i) {
    const RankGroup group = slots.group(rows[i]);
    rows_of_rank[group.has(rank) ? rank : group.first].push_back(i);
  }
  std::vector<int> sent;
  slot_counts_.resize(n_ranks);
  for (const std::vector<int>& some : rows_of_rank) {
    row_counts_.push_back(static_cast<int>(some.size()));
    rows_.insert(rows_.end(), some.begin(), some.end());
    for (const int i : some) sent.push_back(rows[i]);
  }
  MPI_Alltoall(row_counts_.data(), 1, MPI_INT, slot_counts_.data(), 1, MPI_INT, comm_);
  row_starts_ = offsets(row_counts_);
  slot_starts_ = offsets(slot_counts_);
  slots_.resize(slot_starts_.back());
  MPI_Alltoallv(sent.data(), row_counts_.data(), row_starts_.data(), MPI_INT, slots_.data(),
                slot_counts_.data(), slot_starts_.data(), MPI_INT, comm_);
  for (int& row : slots_) row = slots.slot(row);
  const int last = slots.here.empty() ? -1 : std::ranges::max(slots.here);
  std::vector<char> is_got(std::size_t(last + 1), 0);
  for (const int slot : slots_) is_got[slot] = 1;
  for (const int slot : slots.here)
    if (is_got[slot] == 0) zero_slots_.push_back(slot);
}

void SlotExchange::to_slots(LocalColumns X, PetscInt first, Panels panels) const
{
  const PanelRows here{.n = static_cast<PetscInt>(rows_.size()), .rows = rows_.data()};
  const PanelRows alone{.n = here.n, .rows = rows_.data(), .slots = slots_.data()};
  const bool is_alone = petsc::size(comm_) == 1;
  const RowType row_of_panel(panel_width);
  std::vector<double> out(is_alone ? 0 : rows_.size() * panel_width),
      in(is_alone ? 0 : slots_.size() * panel_width);
  for (int p = 0; p < panels.n_panels; ++p, first += panel_width) {
    double* panel = panels.values + p * panels.stride;
    if (is_alone) {
      pack(X, first, alone, panel);
      continue;
    }
    pack(X, first, here, out.data());
    MPI_Alltoallv(out.data(), row_counts_.data(), row_starts_.data(), row_of_panel, in.data(),
                  slot_counts_.data(), slot_starts_.data(), row_of_panel, comm_);
    put(in.data(), slots_, panel);
    for (const int slot : zero_slots_)
      std::fill_n(panel + std::size_t(slot) * panel_width, panel_width, 0.0);
  }
}

void SlotExchange::to_rows(Panels panels, std::span<const int> columns, LocalColumns X,
                           std::span<const char> is_zero) const
{
  const PanelRows here{.n = static_cast<PetscInt>(rows_.size()), .rows = rows_.data()};
  const PanelRows alone{.n = here.n, .rows = rows_.data(), .slots = slots_.data()};
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
      unpack(panel, alone, some, X, is_zero);
      continue;
    }
    get(panel, slots_, out.data());
    MPI_Alltoallv(out.data(), slot_counts_.data(), slot_starts_.data(), row_of_panel, in.data(),
                  row_counts_.data(), row_starts_.data(), row_of_panel, comm_);
    unpack(in.data(), here, some, X, is_zero);
  }
}

}  // namespace chladni::linear
