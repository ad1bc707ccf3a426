#include "linear/cholesky/supernodal/shared_fronts.hpp"

#include <petscblaslapack.h>
#include <petscsys.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "linear/cholesky/supernodal/fronts.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"
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

// needs the types of petscsys.h

namespace {

constexpr int shared_block_columns = 64;  // of a lower triangle that are updated as a rectangle

/// Columns first .. last - 1 of a front, and where the rows of this rank stand.
struct ColumnGroup {
  int first, last;
  int n_above, n_inside;  ///< own rows above the group, and in its triangle

  int size() const { return last - first; }
  int n_before() const { return n_above + n_inside; }
};

struct Workspace {
  double *block, *scaled_block, *sent, *received, *all;
};

Workspace workspace(const DealtFront& front)
{
  constexpr std::size_t n_block = std::size_t(columns_together) * columns_together;
  const std::size_t n_own = std::size_t(front.n_own()) * columns_together;
  const std::size_t n_all = std::size_t(front.rows.n_rows()) * columns_together;
  double* at = front.workspace;
  const auto take = [&](std::size_t n) { return (at += n) - n; };
  return {.block = take(n_block),
          .scaled_block = take(n_block),
          .sent = take(n_own),
          .received = take(n_all),
          .all = take(n_all)};
}

/// Some rows of a front, of which `own` [as many as this rank has x n_columns] are here.
struct SomeRows {
  int first, last, n_columns;
  const double* own;
  std::size_t leading_dimension;
};

/// All of some rows, in their order, by columns.
void gather_rows(const DealtFront& front, const SomeRows& some, const Workspace& work, double* all)
{
  std::vector<int> counts;
  for (int q = 0; q < petsc::size(front.comm); ++q)
    counts.push_back(front.rows.count(q, some.first, some.last) * some.n_columns);
  const std::vector<int> at = offsets(counts);
  const std::size_t n_own = front.rows.count(front.place, some.first, some.last);
  for (std::size_t c = 0; c < std::size_t(some.n_columns); ++c)
    std::copy_n(some.own + c * some.leading_dimension, n_own, work.sent + c * n_own);
  MPI_Allgatherv(work.sent, counts[std::size_t(front.place)], MPI_DOUBLE, work.received,
                 counts.data(), at.data(), MPI_DOUBLE, front.comm);
  const std::size_t n = some.last - some.first;
  for (int q = 0; q < std::ssize(counts); ++q) {
    const double* from = work.received + at[std::size_t(q)];
    const std::size_t n_of_rank = std::size_t(counts[std::size_t(q)] / some.n_columns);
    front.rows.for_tiles(q, [&](const RowTile& tile) {
      const int first = std::max(tile.first, some.first);
      const int n_rows = std::min(tile.first + tile.n_rows, some.last) - first;
      if (n_rows <= 0) return;
      double* to = all + std::size_t(first - some.first);
      for (std::size_t c = 0; c < std::size_t(some.n_columns); ++c)
        std::copy_n(from + c * n_of_rank, n_rows, to + c * n);
      from += n_rows;
    });
  }
}

/// The triangle of some columns, eliminated on all ranks alike.
int eliminate_block(const DealtFront& front, const ColumnGroup& columns, const Workspace& work)
{
  const std::size_t n_own = front.n_own(), w = front.rows.n_columns();
  const int k = columns.size();
  double* own = front.L + std::size_t(columns.n_above) + std::size_t(columns.first) * n_own;
  gather_rows(front, {columns.first, columns.last, k, own, n_own}, work, work.block);
  const int n_negative =
      eliminate_columns({.A = work.block, .W = work.scaled_block, .n_rows = k, .n_columns = k});
  for (int c = 0; c < k; ++c) {
    const double* column = work.block + std::size_t(c) * std::size_t(k);
    front.D[columns.first + c] = column[c];
    std::copy_n(column + c, k - c, front.triangle + std::size_t(columns.first + c) * (w + 1));
    double* to = own + std::size_t(c) * n_own;
    front.rows.for_rows(front.place, columns.first, columns.last,
                        [&](int row) { *to++ = column[row - columns.first]; });
  }
  return n_negative;
}

/// Own rows under the columns become those of L; all of them are gathered as L D.
void eliminate_under(const DealtFront& front, const ColumnGroup& columns, const Workspace& work)
{
  const std::size_t n_own = front.n_own(), w = front.rows.n_columns();
  const PetscBLASInt n = static_cast<int>(n_own) - columns.n_before(), k = columns.size();
  const auto ld = static_cast<PetscBLASInt>(n_own);
  const double one = 1.0;
  double* own = front.L + std::size_t(columns.n_before()) + std::size_t(columns.first) * n_own;
  if (n > 0) BLAStrsm_("R", "L", "T", "U", &n, &k, &one, work.block, &k, own, &ld);
  const std::size_t n_all = front.rows.n_rows() - columns.last;
  gather_rows(front, {columns.last, front.rows.n_rows(), k, own, n_own}, work, work.all);
  const std::size_t n_under = w - std::size_t(columns.last);
  for (int c = 0; c < k; ++c) {
    const double inverse = 1.0 / front.D[columns.first + c];
    for (double* x = own + std::size_t(c) * n_own; x != own + std::size_t(c) * n_own + n; ++x)
      *x *= inverse;
    const double* from = work.all + std::size_t(c) * n_all;
    double* to = front.triangle + std::size_t(columns.first + c) * w + std::size_t(columns.last);
    for (std::size_t i = 0; i < n_under; ++i) to[i] = from[i] * inverse;
  }
}

/// A lower triangle of the columns and rows first .. last - 1 of a front, and the rows below.
struct Updated {
  int first, last;
  double* values;  ///< [own rows from `first` on x (last - first)]
  std::size_t leading_dimension;
};

/// Y <- Y - L (L D)^T for the own rows.
void update(const DealtFront& front, const ColumnGroup& columns, const Workspace& work,
            const Updated& Y)
{
  const double one = 1.0, minus_one = -1.0;
  const auto n_own = static_cast<PetscBLASInt>(front.n_own()), k = PetscBLASInt(columns.size());
  const PetscBLASInt n_all = front.rows.n_rows() - columns.last;
  const auto ld = static_cast<PetscBLASInt>(Y.leading_dimension);
  const int before = front.rows.count(front.place, 0, Y.first);
  for (int c = Y.first; c < Y.last; c += shared_block_columns) {
    const PetscBLASInt width = std::min(shared_block_columns, Y.last - c);
    const int above = front.rows.count(front.place, 0, c);
    const PetscBLASInt n = n_own - above;
    if (n == 0) return;
    BLASgemm_("N", "T", &n, &width, &k, &minus_one,
              front.L + std::size_t(above) + std::size_t(columns.first) * std::size_t(n_own),
              &n_own, work.all + (c - columns.last), &n_all, &one,
              Y.values + (above - before) + std::size_t(c - Y.first) * Y.leading_dimension, &ld);
  }
}

}  // namespace

std::size_t size_of_workspace(const DealtRows& rows, int place)
{
  const std::size_t n = 2 * std::size_t(columns_together) + rows.count(place, 0, rows.n_rows()) +
                        2 * std::size_t(rows.n_rows());
  return n * columns_together;
}

int eliminate_dealt(const DealtFront& front)
{
  const Workspace work = workspace(front);
  const int w = front.rows.n_columns();
  const std::size_t n_own = front.n_own(), n_pivots = front.n_own_pivots();
  int n_negative = 0;
  bool has_failed = false;
  for (int first = 0; first < w; first += columns_together) {
    const int last = std::min(first + columns_together, w);
    const ColumnGroup columns{.first = first,
                              .last = last,
                              .n_above = front.rows.count(front.place, 0, first),
                              .n_inside = front.rows.count(front.place, first, last)};
    const int n = eliminate_block(front, columns, work);
    has_failed = has_failed || n < 0;
    n_negative += n;
    if (last == front.rows.n_rows()) break;
    eliminate_under(front, columns, work);
    update(front, columns, work,
           {.first = last,
            .last = w,
            .values = front.L + std::size_t(columns.n_before()) + std::size_t(last) * n_own,
            .leading_dimension = n_own});
    update(front, columns, work,
           {.first = w,
            .last = front.rows.n_rows(),
            .values = front.rest,
            .leading_dimension = n_own - n_pivots});
  }
  return has_failed ? -1 : n_negative;
}

void divide_by_triangle(const DealtFront& front)
{
  const double one = 1.0;
  const PetscBLASInt w = front.rows.n_columns();
  const auto ld = static_cast<PetscBLASInt>(front.n_own());
  const int n_pivots = front.n_own_pivots();
  std::vector<int> pivots;
  front.rows.for_rows(front.place, 0, w, [&](int row) { pivots.push_back(row); });
  // The rows of an inverse end on its diagonal: some tiles at a time, with the leading part of
  // L_11.
  constexpr int some_rows = 10 * tile_rows;
  for (int i = 0; i < n_pivots; i += some_rows) {
    const PetscBLASInt n = std::min(some_rows, n_pivots - i);
    const PetscBLASInt n_columns = pivots[std::size_t(i + n - 1)] + 1;
    for (int c = 0; c < n_columns; ++c)
      for (int k = i; k < i + n; ++k)
        front.L[std::size_t(k) + std::size_t(c) * std::size_t(ld)] = c == pivots[std::size_t(k)];
    BLAStrsm_("R", "L", "N", "U", &n, &n_columns, &one, front.triangle, &w, front.L + i, &ld);
  }
  const PetscBLASInt n_below = ld - n_pivots;
  if (n_below > 0)
    BLAStrsm_("R", "L", "N", "U", &n_below, &w, &one, front.triangle, &w, front.L + n_pivots, &ld);
}

}  // namespace chladni::linear
