#pragma once

#include <vector>

#include "linear/cholesky/supernodal/assembly_tree.hpp"

namespace chladni::linear {

/// Ranks first .. last - 1, which eliminate some supernodes alike.
struct RankGroup {
  int first, last;

  int size() const { return last - first; }
  bool has(int rank) const { return first <= rank && rank < last; }
  bool operator==(const RankGroup&) const = default;
};

/// The groups of more than one rank that a rank belongs to, the smallest first: all ranks, the half
/// of them that it is in, and so on.
std::vector<RankGroup> groups_of(int rank, int n_ranks);

/// Who eliminates which supernode. All ranks take what parts a tree into two subtrees for one half
/// of them each, and so on down to whole subtrees of single ranks; a front is repeated on no other
/// ranks than those whose subtrees hang below it. Each tree of a good part of the work is shared
/// out by itself, so that it can be solved without the others.
/// @return [n_supernodes] one rank, or a group of `groups_of`; a child's is within its parent's.
/// Source: George, Liu and Ng, Parallel Computing 10 (1989) 287.
std::vector<RankGroup> share_subtrees(const AssemblyTree& tree, int n_ranks);

}  // namespace chladni::linear
