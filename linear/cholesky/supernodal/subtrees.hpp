#pragma once

#include <vector>

#include "linear/cholesky/supernodal/assembly_tree.hpp"

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

}  // namespace chladni::linear
