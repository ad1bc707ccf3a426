#pragma once

#include <vector>

#include "linear/cholesky/supernodal/quotient_graph.hpp"

namespace chladni::linear {

/// Vertices of the quotient graph that are eliminated one after the other with the same structure.
struct FundamentalSupernode {
  std::vector<int> columns;  ///< vertices in the order of their elimination
  std::vector<int> below;    ///< vertices, in the order of their elimination
  int parent = -1;           ///< index of the parent supernode; -1 for a root
};

/// The supernodes without stored zeros, children before parents.
/// @param order  the vertices in the order of their elimination
std::vector<FundamentalSupernode> fundamental_supernodes(const QuotientGraph& graph,
                                                         const std::vector<int>& order);

}  // namespace chladni::linear
