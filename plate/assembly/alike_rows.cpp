#include "plate/assembly/alike_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <span>

#include "plate/assembly/node_values.hpp"

namespace chladni::plate {

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
