#include "plate/assembly/block_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <span>

#include "common/checked_count.hpp"

namespace chladni::plate {

namespace {

/// The columns that each row of a block holds if it does not hold all.
class HeldColumns {
 public:
  explicit HeldColumns(const HeldBlocks& blocks) : n_(blocks.pattern.n), begin_(std::size_t(n_) + 1)
  {
    for (const int component : blocks.held) {
      column_.push_back(component % n_);
      ++begin_[std::size_t(component / n_) + 1];
    }
    std::inclusive_scan(begin_.begin(), begin_.end(), begin_.begin());
  }

  /// Calls visit(j, value) for the entries that row i of a block holds.
  template <typename Number, typename Visit>
  void for_row(std::span<Number> block, int i, const Visit& visit) const
  {
    if (std::ssize(block) == std::ptrdiff_t(n_) * n_) {
      for (int j = 0; j < n_; ++j) visit(j, block[i * n_ + j]);
      return;
    }
    for (std::size_t s = begin_[i]; s < begin_[i + 1]; ++s) visit(column_[s], block[s]);
  }

 private:
  int n_;
  std::vector<int> column_;         ///< of each value of a block, by rows
  std::vector<std::size_t> begin_;  ///< [n + 1] first value of each row
};

class RowSplitter {
 public:
  RowSplitter(const HeldBlocks& blocks, const std::vector<BlockEntries>& entries,
              std::vector<double> values)
      : blocks_(blocks), held_(blocks), entries_(entries)
  {
    rows_.column = std::make_unique_for_overwrite<PetscInt[]>(values.size());
    rows_.value = std::move(values);
  }

  SplitRows rows() &&
  {
    const BlockPattern& pattern = blocks_.pattern;
    for (PetscInt node = 0; node < pattern.n_rows(); ++node) {
      const std::ptrdiff_t begin = pattern.start[node], end = pattern.start[node + 1];
      of_node_.assign(rows_.value.begin() + blocks_.offset[begin],
                      rows_.value.begin() + blocks_.offset[end]);
      for (int i = 0; i < pattern.n; ++i) {
        append(node, i);
        rows_.start.push_back(checked(count_));
        rows_.other_start.push_back(checked(std::ssize(rows_.other_column)));
      }
    }
    give_back_room();
    return std::move(rows_);
  }

 private:
  /// Of entries that do not count: in a shell that is flat in parts these are half of all.
  void give_back_room()
  {
    const auto n = static_cast<std::size_t>(count_);
    if (n == rows_.value.size()) return;
    rows_.value.resize(n);
    rows_.value.shrink_to_fit();
    auto column = std::make_unique_for_overwrite<PetscInt[]>(n);
    std::copy_n(rows_.column.get(), n, column.get());
    rows_.column = std::move(column);
  }

  static PetscInt checked(std::ptrdiff_t n)
  {
    return checked_count(n, "entries of K or M in the rows of one rank", "use more ranks");
  }

  void append(PetscInt node, int i)
  {
    const BlockPattern& pattern = blocks_.pattern;
    const std::ptrdiff_t begin = pattern.start[node], end = pattern.start[node + 1];
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      const std::span<const double> block(
          of_node_.data() + blocks_.offset[k] - blocks_.offset[begin],
          static_cast<std::size_t>(blocks_.offset[k + 1] - blocks_.offset[k]));
      const PetscInt column_node = pattern.column[k], own_node = column_node - pattern.first;
      const BlockEntries of_row = entries_[std::size_t(k)] >> (pattern.n * i);
      if (own_node >= 0 && own_node < pattern.n_rows()) {
        held_.for_row(block, i, [&](int j, double value) {  // the next overwrites what is none
          rows_.column[count_] = pattern.n * own_node + j;
          rows_.value[static_cast<std::size_t>(count_)] = value;
          count_ += static_cast<std::ptrdiff_t>(of_row >> j & 1);
        });
        continue;
      }
      held_.for_row(block, i, [&](int j, double value) {
        if ((of_row >> j & 1) == 0) return;
        rows_.other_column.push_back(pattern.n * column_node + j);
        rows_.other_value.push_back(value);
      });
    }
  }

  const HeldBlocks& blocks_;
  HeldColumns held_;
  const std::vector<BlockEntries>& entries_;
  SplitRows rows_;
  std::ptrdiff_t count_ = 0;
  std::vector<double> of_node_;  ///< the sums of the node at hand, whose place its rows take
};

}  // namespace

std::vector<double> diagonal_scales(const HeldBlocks& blocks, const std::vector<double>& values)
{
  const BlockPattern& pattern = blocks.pattern;
  const int n = pattern.n;
  const HeldColumns held(blocks);
  std::vector<double> scales;
  scales.reserve(std::size_t(pattern.n_rows()) * n);
  for (PetscInt node = 0; node < pattern.n_rows(); ++node) {
    const auto begin = pattern.column.begin() + pattern.start[node];
    const auto end = pattern.column.begin() + pattern.start[node + 1];
    const auto found = std::lower_bound(begin, end, pattern.first + node);
    if (found == end || *found != pattern.first + node) {  // no element has this node
      scales.insert(scales.end(), n, 0.0);
      continue;
    }
    const auto place = found - pattern.column.begin();
    const std::span<const double> block(
        values.data() + blocks.offset[place],
        static_cast<std::size_t>(blocks.offset[place + 1] - blocks.offset[place]));
    for (int i = 0; i < n; ++i) {
      held.for_row(block, i, [&](int j, double value) {
        if (i == j) scales.push_back(std::sqrt(std::abs(value)));
      });
    }
  }
  return scales;
}

std::vector<BlockEntries> sifted(const HeldBlocks& blocks, const Sieve& sieve,
                                 std::vector<double>& values)
{
  const BlockPattern& pattern = blocks.pattern;
  const int n = pattern.n;
  const HeldColumns held(blocks);
  std::vector<BlockEntries> entries(pattern.column.size(), 0);
  for (PetscInt node = 0; node < pattern.n_rows(); ++node) {
    const double* row_scales = sieve.of(pattern.first + node);
    for (std::ptrdiff_t k = pattern.start[node]; k < pattern.start[node + 1]; ++k) {
      const std::span<double> block(
          values.data() + blocks.offset[k],
          static_cast<std::size_t>(blocks.offset[k + 1] - blocks.offset[k]));
      const double* column_scales = sieve.of(pattern.column[k]);
      BlockEntries& of_block = entries[std::size_t(k)];
      for (int i = 0; i < n; ++i) {
        held.for_row(block, i, [&](int j, double& value) {
          if (sieve.counts(value, row_scales[i], column_scales[j]))
            of_block |= BlockEntries{1} << (n * i + j);
          else
            value = 0.0;
        });
      }
      if (pattern.column[k] == pattern.first + node)
        for (int i = 0; i < n; ++i) of_block |= BlockEntries{1} << (n * i + i);
    }
  }
  return entries;
}

SplitRows split_rows(const HeldBlocks& blocks, std::vector<double> values,
                     const std::vector<BlockEntries>& entries)
{
  return RowSplitter(blocks, entries, std::move(values)).rows();
}

namespace {

/// Some DOFs of a node.
using Dofs = std::uint64_t;

constexpr int most_dofs = 8;  // of a node: 64 entries of a block

/// For each DOF of a node, itself and those that it is alike with.
using Alike = std::array<Dofs, most_dofs>;

Dofs dof(int i)
{
  return Dofs{1} << i;
}

Dofs all_dofs(int n)
{
  return dof(n) - 1;
}

Dofs row_of(BlockEntries entries, int n, int i)
{
  return entries >> (n * i) & all_dofs(n);
}

template <typename Visit>
void for_dofs(Dofs dofs, int n, const Visit& visit)
{
  for (int i = 0; i < n; ++i)
    if ((dofs & dof(i)) != 0) visit(i);
}

/// How many columns the rows of a node have in common, each row with itself all.
class CommonColumns {
 public:
  explicit CommonColumns(int n) : n_(n) {}

  void add(BlockEntries entries, int times)
  {
    for (int i = 0; i < n_; ++i)
      for (int k = 0; k <= i; ++k)
        number_[i][k] += times * std::popcount(row_of(entries, n_, i) & row_of(entries, n_, k));
  }
  bool are_alike(int i, int k) const  // k < i
  {
    return 2 * number_[i][k] > std::max(number_[i][i], number_[k][k]);
  }

 private:
  int n_;
  std::array<std::array<int, most_dofs>, most_dofs> number_{};
};

/// Calls visit(entries, times) for the blocks of a node, most of which are like those before.
template <typename Visit>
void for_runs(std::span<const BlockEntries> blocks, const Visit& visit)
{
  for (std::size_t k = 0; k < blocks.size();) {
    const std::size_t first = k;
    while (k < blocks.size() && blocks[k] == blocks[first]) ++k;
    visit(blocks[first], static_cast<int>(k - first));
  }
}

/// Entries that rows of a node have besides their own when those that are alike have the same.
struct Growth {
  int entries = 0, added = 0;

  void add(BlockEntries block, int times, int n, const Alike& alike)
  {
    for (int i = 0; i < n; ++i) {
      Dofs wide = 0;
      for_dofs(alike[i], n, [&](int k) { wide |= row_of(block, n, k); });
      const int own = std::popcount(row_of(block, n, i));
      entries += times * own;
      added += times * (std::popcount(wide) - own);
    }
  }
};

/// Rows that share more than half of the columns of the longer one, directly or by way of others;
/// none where that would add many entries, as on a plate of rectangles.
Alike alike_rows(std::span<const BlockEntries> blocks, int n)
{
  CommonColumns common(n);
  for_runs(blocks, [&](BlockEntries entries, int times) { common.add(entries, times); });
  Alike alone{};
  for (int i = 0; i < n; ++i) alone[i] = dof(i);
  Alike alike = alone;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) {
      if (!common.are_alike(i, k)) continue;
      alike[i] |= dof(k);
      alike[k] |= dof(i);
    }
  }
  for (int k = 0; k < n; ++k) for_dofs(alike[k], n, [&](int i) { alike[i] |= alike[k]; });
  Growth growth;
  for_runs(blocks, [&](BlockEntries entries, int times) { growth.add(entries, times, n, alike); });
  constexpr int many = 20;  // one in so many
  return many * growth.added > growth.entries ? alone : alike;
}

/// The entries, and all between some rows and columns that are alike where more than half are
/// there.
BlockEntries filled(BlockEntries entries, int n, const Alike& rows, const Alike& columns)
{
  BlockEntries all = entries;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      BlockEntries between = 0;
      for_dofs(rows[i], n, [&](int k) { between |= columns[j] << (n * k); });
      if ((entries & between) == between || (entries & between) == 0) continue;
      if (2 * std::popcount(entries & between) > std::popcount(between)) all |= between;
    }
  }
  return all;
}

/// Whole numbers up to 2^53 pass through doubles unharmed.
std::vector<double> as_numbers(const BlockPattern& pattern,
                               const std::vector<BlockEntries>& entries)
{
  std::vector<double> numbers;
  for (PetscInt node = 0; node < pattern.n_rows(); ++node) {
    const std::ptrdiff_t begin = pattern.start[node], end = pattern.start[node + 1];
    const Alike alike = alike_rows({entries.data() + begin, entries.data() + end}, pattern.n);
    for (int i = 0; i < pattern.n; ++i) numbers.push_back(static_cast<double>(alike[i]));
  }
  return numbers;
}

Alike alike_of(const NodeValues& nodes, PetscInt node, int n)
{
  Alike alike{};
  for (int i = 0; i < n; ++i) alike[i] = static_cast<Dofs>(nodes.of(node)[i]);
  return alike;
}

}  // namespace

void make_rows_alike(const BlockPattern& pattern, std::vector<BlockEntries>& entries,
                     BlockEntries room, MPI_Comm comm)
{
  assert(pattern.n <= most_dofs);
  const int n = pattern.n;
  const NodeValues nodes(pattern, as_numbers(pattern, entries), comm);
  for (PetscInt node = 0; node < pattern.n_rows(); ++node) {
    const Alike rows = alike_of(nodes, pattern.first + node, n);
    Alike columns{}, columns_before{};
    BlockEntries before = 0, filled_before = 0;  // most blocks are like those before
    for (std::ptrdiff_t k = pattern.start[node]; k < pattern.start[node + 1]; ++k) {
      columns = alike_of(nodes, pattern.column[k], n);
      if (entries[k] != before || columns != columns_before) {
        before = entries[k];
        columns_before = columns;
        filled_before = before | (filled(before, n, rows, columns) & room);
      }
      entries[k] = filled_before;
    }
  }
}

}  // namespace chladni::plate
