#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "linear/cholesky/supernodal/quotient_graph.hpp"

namespace chladni::linear {

/// The vertices of a quotient graph in supernodes without stored zeros: vertices that are
/// eliminated one after the other with the same structure. Children come before parents.
struct FundamentalSupernodes {
  std::vector<int> order;         ///< [n_vertices] in the order of their elimination, a postorder
  std::vector<int> first_column;  ///< [n + 1] place of the first vertex of each
  std::vector<int> parent;        ///< [n]; -1 for a root
  std::vector<std::size_t> below_first, below_last;  ///< [n] of its places in `below`
  std::vector<int> below;  ///< places of the vertices below each, ascending, with gaps between

  int size() const { return static_cast<int>(parent.size()); }
  std::span<const int> below_of(int s) const
  {
    return std::span(below).subspan(below_first[s], below_last[s] - below_first[s]);
  }
};

/// @param order  the vertices in the order of their elimination; kept up to a postorder
FundamentalSupernodes fundamental_supernodes(const QuotientGraph& graph,
                                             const std::vector<int>& order);

}  // namespace chladni::linear
