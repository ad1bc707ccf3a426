#include "linear/cholesky/supernodal/shared_fronts.hpp"

#include <algorithm>
#include <cstdint>

#include "linear/cholesky/supernodal/shared_columns.hpp"
#include "linear/kernels/gather.hpp"

namespace chladni::linear {

/// The rank that has a row of what s left over.
int SharedFronts::owner_below(int s, const DealtRows& rows, int below) const
{
  return group_[s].first + (group_[s].size() == 1 ? 0 : rows.place(rows.n_columns() + below));
}

std::vector<SharedFronts::MovedRow> SharedFronts::sent_rows(int child) const
{
  std::vector<MovedRow> moved;
  const std::span<const int> below = tree_.below(child);
  const DealtRows rows = dealt_rows(tree_, child, group_[child]);
  for (int i = 0, own = 0; i < std::ssize(below); ++i) {
    if (owner_below(child, rows, i) != rank_) continue;
    moved.push_back({.row = i, .own = own++, .other = front_.rows.place(places_.place(below[i]))});
  }
  return moved;
}

std::vector<SharedFronts::MovedRow> SharedFronts::received_rows(int child) const
{
  std::vector<MovedRow> moved;
  const std::span<const int> below = tree_.below(child);
  const DealtRows rows = dealt_rows(tree_, child, group_[child]);
  const int first = rank_ - front_.place;
  for (int i = 0; i < std::ssize(below); ++i) {
    const int own = own_row_[places_.place(below[i])];
    if (own == -1) continue;
    moved.push_back({.row = i, .own = own, .other = owner_below(child, rows, i) - first});
  }
  return moved;
}

/// The lower triangles of rows that move: row i has i + 1 numbers.
void SharedFronts::plan_exchange(int s)
{
  using Counts = std::vector<std::int64_t>;
  Counts sent(group_[s].size(), 0), received(group_[s].size(), 0);
  for (const int child : own_.children(s)) {
    for (const MovedRow& row : sent_rows(child)) sent[row.other] += row.row + 1;
    for (const MovedRow& row : received_rows(child)) received[row.other] += row.row + 1;
  }
  const auto checked = [](const Counts& counts) {
    std::vector<int> all;
    for (const std::int64_t count : counts)
      all.push_back(checked_count(count, "numbers of a front for one rank", "use more ranks"));
    return all;
  };
  sent_counts_ = checked(sent);
  received_counts_ = checked(received);
  sent_at_ = offsets(sent_counts_);
  received_at_ = offsets(received_counts_);
  sent_.of(sent_at_.back());
  received_.of(received_at_.back());
}

void SharedFronts::prepare(int s, const MatrixRows& A)
{
  front_.rows = dealt_rows(tree_, s, group_[s]);
  front_.place = rank_ - group_[s].first;
  places_.enter(s);
  const std::size_t w = tree_.n_columns(s), m = tree_.n_below[s];
  const std::size_t n_own = front_.n_own(),
                    n_own_below = n_own - std::size_t(front_.n_own_pivots());
  own_row_.assign(w + m, -1);
  int n = 0;
  front_.rows.for_rows(front_.place, 0, front_.rows.n_rows(),
                       [&](int row) { own_row_[row] = n++; });
  left_over_[s].assign(n_own_below * m, 0.0);
  plan_exchange(s);
  front_.L = L_.of(n_own * w);
  front_.rest = left_over_[s].data();
  front_.triangle = triangle_.of(w * w);
  front_.D = D_.of(w);
  front_.workspace = workspace_.of(size_of_workspace(front_.rows, front_.place));
  std::fill_n(front_.L, n_own * w, 0.0);
  places_.for_entries(A, [&](int row, int column, double value) {
    if (own_row_[row] != -1)
      front_.L[std::size_t(own_row_[row]) + std::size_t(column) * n_own] += value;
  });
}

/// Column by column, in each the rows of each rank.
void SharedFronts::pack(int s)
{
  std::vector<int> next(sent_at_.begin(), sent_at_.end() - 1);
  double* const sent = sent_.numbers.get();
  for (const int child : own_.children(s)) {
    const std::vector<MovedRow> rows = sent_rows(child);
    if (rows.empty()) continue;
    const bool is_alone = group_[child].size() == 1;
    const double* column = is_alone ? own_.left_over(child) : left_over_[child].data();
    std::size_t first = 0;
    for (int j = 0; j < tree_.n_below[child]; ++j, column += rows.size()) {
      while (first < rows.size() && rows[first].row < j) ++first;
      for (std::size_t k = first; k < rows.size(); ++k)
        sent[next[rows[k].other]++] = column[rows[k].own];
    }
    if (is_alone)
      own_.forget_left_over(child);
    else
      std::vector<double>().swap(left_over_[child]);
  }
}

void SharedFronts::unpack(int s)
{
  std::vector<int> next(received_at_.begin(), received_at_.end() - 1);
  const double* const received = received_.numbers.get();
  const int w = front_.rows.n_columns();
  const std::size_t n_own = front_.n_own(), n_pivots = front_.n_own_pivots();
  for (const int child : own_.children(s)) {
    const std::vector<MovedRow> rows = received_rows(child);
    if (rows.empty()) continue;
    const std::span<const int> below = tree_.below(child);
    std::size_t first = 0;
    for (int j = 0; j < std::ssize(below); ++j) {
      while (first < rows.size() && rows[first].row < j) ++first;
      const int column = places_.place(below[j]);
      double* to = column < w ? front_.L + std::size_t(column) * n_own
                              : front_.rest + std::size_t(column - w) * (n_own - n_pivots);
      const int before = column < w ? 0 : static_cast<int>(n_pivots);
      for (std::size_t k = first; k < rows.size(); ++k)
        to[rows[k].own - before] += received[next[rows[k].other]++];
    }
  }
}

int SharedFronts::eliminate(int s, MPI_Comm comm)
{
  front_.comm = comm;
  pack(s);
  MPI_Alltoallv(sent_.numbers.get(), sent_counts_.data(), sent_at_.data(), MPI_DOUBLE,
                received_.numbers.get(), received_counts_.data(), received_at_.data(), MPI_DOUBLE,
                comm);
  unpack(s);
  return eliminate_dealt(front_);
}

}  // namespace chladni::linear
