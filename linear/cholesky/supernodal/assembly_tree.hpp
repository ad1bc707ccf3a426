#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "linear/cholesky/supernodal/quotient_graph.hpp"

namespace chladni::linear {

/// The columns of a Cholesky factor in supernodes: neighbouring columns with the same rows below
/// them. Some zeros are stored so that supernodes are fewer and wider. Children come before their
/// parents.
/// Source: Liu, SIAM Review 34 (1992) 82; Ashcraft and Grimes, ACM TOMS 15 (1989) 291.
struct AssemblyTree {
  std::vector<int> position;      ///< [n] place of each row of the matrix in the elimination
  std::vector<int> row;           ///< [n] row at each place
  std::vector<int> first_column;  ///< [n_supernodes + 1] first place of each
  std::vector<int> parent;        ///< [n_supernodes]; -1 for a root
  std::vector<int> n_below;       ///< [n_supernodes] rows below each
  std::vector<std::size_t> below_starts;  ///< [n_supernodes + 1]
  std::vector<int> below_rows;            ///< places below the supernodes that matter, ascending

  int n_supernodes() const { return static_cast<int>(parent.size()); }
  int n_columns(int s) const { return first_column[s + 1] - first_column[s]; }
  /// [n_below] of a supernode that matters; nothing of the others.
  std::span<const int> below(int s) const
  {
    return std::span(below_rows).subspan(below_starts[s], below_starts[s + 1] - below_starts[s]);
  }
  /// Number of stored entries of the factor in the columns of s.
  double n_entries(int s) const;
  /// Floating-point operations of the elimination of s.
  double n_operations(int s) const;
};

/// Whether each supernode of a tree matters, of which all but the rows below them is known.
using WhatMatters = std::function<std::vector<char>(const AssemblyTree& tree)>;

/// Makes the tree of an elimination order.
/// @param places   [n] wanted place of each row in the elimination; kept up to a postorder
/// @param matters  asks for the rows below some supernodes alone, most of the memory; null: of all
AssemblyTree assembly_tree(const QuotientGraph& graph, const std::vector<int>& places,
                           const WhatMatters& matters = {});

}  // namespace chladni::linear
