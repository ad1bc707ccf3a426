#pragma once

#include <cstddef>
#include <span>

#include "linear/cholesky/supernodal/rank_groups.hpp"

namespace chladni::linear {

/// A few right-hand sides or solutions: panels of eight columns, stored by rows and aligned to
/// cache lines.
struct Panels {
  double* values;
  std::size_t stride;  ///< numbers from one panel to the next
  int n_panels;
};

/// The columns of one supernode of a factor L D L^T in the order in which triangular solutions read
/// them: tiles of six rows from top to bottom. The last tile of the triangle and the last one below
/// it are filled up with zeros; the diagonal holds D^-1.
struct TiledColumns {
  const double* values;
  int n_columns;
  int first;                   ///< row of its first column in the panels
  std::span<const int> below;  ///< rows of the panels below it
};

/// The number of values in the tiles of n_columns columns with n_below rows below.
std::size_t tiled_size(int n_columns, int n_below);

/// Stores columns as tiles.
/// @param columns  [(n_columns + n_below) x n_columns] by columns, D on the diagonal, the part
///                 above unused
void store_tiles(const double* columns, int n_columns, int n_below, double* tiles);

/// X <- L^-1 X for the columns of L in one supernode.
void solve_forward(const TiledColumns& L, Panels X);

/// X <- L^-T D^-1 X for the columns of L in one supernode.
void solve_backward(const TiledColumns& L, Panels X);

/// X <- D^(-1/2) X for positive D in one supernode.
void scale_by_root(const TiledColumns& L, Panels X);

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
