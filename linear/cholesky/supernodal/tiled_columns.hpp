#pragma once

#include <cstddef>
#include <span>

namespace chladni::linear {

/// A few right-hand sides or solutions: panels of eight columns, each with its rows one after the
/// other, aligned to cache lines.
struct Panels {
  double* values;
  std::size_t stride;  ///< numbers from panel to panel
  int n_panels;
};

/// The columns of one supernode of a factor L D L^T as triangular solutions read them: tiles of
/// six rows from above to below, the last of the triangle and the last below filled up with zeros;
/// D^-1 stands on the diagonal.
struct TiledColumns {
  const double* values;
  int n_columns;
  int first;                   ///< row of its first column in the panels
  std::span<const int> below;  ///< rows of the panels
};

/// Numbers in the tiles of so many columns with so many rows below.
std::size_t tiled_size(int n_columns, int n_below);

/// @param columns  [(n_columns + n_below) x n_columns] by columns, D on the diagonal, nothing
/// above.
void store_tiles(const double* columns, int n_columns, int n_below, double* tiles);

/// X <- L^-1 X for the columns of L in one supernode.
void solve_forward(const TiledColumns& L, Panels X);

/// X <- L^-T D^-1 X
void solve_backward(const TiledColumns& L, Panels X);

/// X <- D^(-1/2) X for positive D.
void scale_by_root(const TiledColumns& L, Panels X);

}  // namespace chladni::linear
