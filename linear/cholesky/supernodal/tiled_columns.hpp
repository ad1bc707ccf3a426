#pragma once

#include <cstddef>
#include <span>

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

}  // namespace chladni::linear
