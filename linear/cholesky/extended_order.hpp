#pragma once

#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// An order of elimination that keeps a known order of some rows: each other row comes right behind
/// the last of those that it has an entry with, or at the end where it has none. Nodes that were
/// left out of a nested dissection come to where it would have had them.
/// @param A      [n x n] AIJ, symmetric
/// @param known  [n] place of each row in the known order, -1 for other rows; the same on all ranks
/// @return [n] place of each row, from 0, on all ranks
/// @note   Collective on the communicator of A.
std::vector<int> extended_order(Mat A, const std::vector<int>& known);

}  // namespace chladni::linear
