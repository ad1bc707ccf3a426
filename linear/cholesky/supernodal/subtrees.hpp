#pragma once

#include <vector>

#include "linear/cholesky/supernodal/assembly_tree.hpp"

namespace chladni::linear {

/// The rank of every rank's own subtrees.
inline constexpr int all_ranks = -1;

/// Who eliminates which supernode: whole subtrees by one rank, what stands above them by all. Each
/// tree of a good part of the work is shared out by itself, so that it can be solved without the
/// others.
/// @return [n_supernodes] a rank, or all_ranks.
/// Source: Geist and Ng, Int. J. Parallel Programming 18 (1989) 291.
std::vector<int> share_subtrees(const AssemblyTree& tree, int n_ranks);

}  // namespace chladni::linear
