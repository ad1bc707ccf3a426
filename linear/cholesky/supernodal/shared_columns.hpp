#pragma once

#include <span>

#include "linear/cholesky/supernodal/dealt_rows.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"

namespace chladni::linear {

/// The columns of a supernode that a group of ranks shares: for the rows of this rank those of
/// L_11^-1 and L_21 L_11^-1, where L_11 are the rows of the columns. A triangular solution is then
/// a product, of which each rank has its rows, with one sum over the group.
/// Source: Raghavan, Parallel Process. Lett. 8 (1998) 29.
struct SharedColumns {
  const double* values;  ///< tiles of six rows; behind those of L_11^-1 six entries of D^-1
  DealtRows rows;
  int place;                   ///< of this rank in the group
  int first;                   ///< row of its first column in the panels
  std::span<const int> below;  ///< rows of the panels below it
};

/// How a group deals out the front of s. Supernodes begin with different ranks.
DealtRows dealt_rows(const AssemblyTree& tree, int s, const RankGroup& group);

/// The number of values of the rank at a place.
std::size_t shared_size(const DealtRows& rows, int place);

/// Stores the rows of a rank.
/// @param own  [own rows x n_columns] by columns: L_11^-1 with the lower triangle alone, L_21
///             L_11^-1
/// @param D    [n_columns]
void store_shared(const DealtRows& rows, int place, const double* own, const double* D,
                  double* values);

/// X <- L^-1 X for the columns of one supernode, where the rows of its columns in X are the same on
/// all ranks. They are left with the ranks that have them, zero on the others; to the rows below
/// each rank adds its part.
void solve_forward(const SharedColumns& L, Panels X);

/// X <- a part of L^-T D^-1 X, the sum of which over the group is the whole: the rows of the
/// columns as `solve_forward` leaves them, those below the same on all ranks.
void solve_backward(const SharedColumns& L, Panels X);

/// X <- D^(-1/2) X for positive D, in the rows of this rank.
void scale_by_root(const SharedColumns& L, Panels X);

}  // namespace chladni::linear
