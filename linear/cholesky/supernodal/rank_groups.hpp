#pragma once

#include <algorithm>
#include <vector>

#include "linear/cholesky/supernodal/assembly_tree.hpp"
#include "linear/kernels/panel_kernels.hpp"

namespace chladni::linear {

/// The ranks first .. last - 1, which eliminate the same supernodes.
struct RankGroup {
  int first, last;

  int size() const { return last - first; }
  bool has(int rank) const { return first <= rank && rank < last; }
  bool operator==(const RankGroup&) const = default;
};

/// The groups of more than one rank that a rank belongs to, smallest first: all ranks, the half of
/// them with this rank, and so on.
std::vector<RankGroup> groups_of(int rank, int n_ranks);

/// Operations of a rank of a group that eliminates s: its share, and with others the inversion of
/// the triangle and the blocks on its diagonal.
double operations_of_rank(const AssemblyTree& tree, int s, int n_ranks);

/// Numbers of the factor in the columns of s that the rank at a place of a group has.
double entries_of_rank(const AssemblyTree& tree, int s, const RankGroup& group, int place);

/// Distributes the supernodes among ranks. The separator that divides a tree into two subtrees, one
/// for each half of the ranks, is eliminated by all of them together, and so on down to whole
/// subtrees of single ranks. Each tree with a large share of the work is distributed separately, so
/// that it can be solved without the others.
/// @return [n_supernodes] one rank, or a group of `groups_of`; that of a child lies within its
///         parent's
/// Source: George, Liu and Ng, Parallel Computing 10 (1989) 287.
std::vector<RankGroup> share_subtrees(const AssemblyTree& tree, int n_ranks);

/// Whether a rank eliminates each supernode, or takes up what is left over of it.
std::vector<char> seen_by(int rank, const AssemblyTree& tree, const std::vector<RankGroup>& group);

/// Rows of a front that stand together, at most as many as a tile of the factor has.
struct RowTile {
  int first;      ///< row of the front
  int n_rows;     ///< of the front; the tile is filled up with zeros
  int n_columns;  ///< without those that are zero in all of its rows
};

/// How many columns of a front a group of ranks eliminates at a time.
inline constexpr int columns_together = 96;

/// How a group of ranks deals out the rows of a front: tile by tile, each in turn to the next rank.
/// The columns have the first rows, and start a tile as do those below them.
class DealtRows {
 public:
  /// @param first_place  in the group, of the rank that gets the first tile
  DealtRows(int n_columns, int n_below, const RankGroup& group, int first_place)
      : n_columns_(n_columns),
        n_below_(n_below),
        n_ranks_(group.size()),
        first_place_(first_place % group.size()),
        n_pivot_tiles_(n_tiles(n_columns)),
        n_all_tiles_(n_pivot_tiles_ + n_tiles(n_below))
  {}

  int n_columns() const { return n_columns_; }
  int n_rows() const { return n_columns_ + n_below_; }
  /// The place in the group of the rank that has a row.
  int place(int row) const
  {
    const int tile =
        row < n_columns_ ? row / tile_rows : n_pivot_tiles_ + (row - n_columns_) / tile_rows;
    return (tile + first_place_) % n_ranks_;
  }
  bool is_pivot(const RowTile& tile) const { return tile.first < n_columns_; }

  /// Calls visit(RowTile) for the tiles of the rank at a place, from top to bottom.
  template <typename Visit>
  void for_tiles(int place, const Visit& visit) const
  {
    const int first = (place - first_place_ + n_ranks_) % n_ranks_;
    for (int k = first; k < n_all_tiles_; k += n_ranks_) visit(tile(k));
  }
  /// Calls visit(row) for the rows first .. last - 1 of the rank at a place, ascending.
  template <typename Visit>
  void for_rows(int place, int first, int last, const Visit& visit) const
  {
    for_tiles(place, [&](const RowTile& tile) {
      const int end = std::min(tile.first + tile.n_rows, last);
      for (int row = std::max(tile.first, first); row < end; ++row) visit(row);
    });
  }
  /// The number of them.
  int count(int place, int first, int last) const
  {
    int n = 0;
    for_tiles(place, [&](const RowTile& tile) {
      n += std::max(0, std::min(tile.first + tile.n_rows, last) - std::max(tile.first, first));
    });
    return n;
  }

 private:
  static int n_tiles(int n_rows) { return (n_rows + tile_rows - 1) / tile_rows; }
  RowTile tile(int k) const
  {
    const bool is_pivot = k < n_pivot_tiles_;
    const int first = is_pivot ? k * tile_rows : n_columns_ + (k - n_pivot_tiles_) * tile_rows;
    const int n = std::min(tile_rows, (is_pivot ? n_columns_ : n_rows()) - first);
    return {.first = first, .n_rows = n, .n_columns = is_pivot ? first + n : n_columns_};
  }

  int n_columns_, n_below_, n_ranks_, first_place_, n_pivot_tiles_, n_all_tiles_;
};

}  // namespace chladni::linear
