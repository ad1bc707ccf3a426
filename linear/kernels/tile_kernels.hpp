#pragma once

#include <cstddef>

namespace chladni::linear {

inline constexpr int tile_rows = 6;    ///< six times eight sums fill the vector registers
inline constexpr int panel_width = 8;  ///< right-hand sides per panel: a cache line

/// Kernels for one tile of six rows of the factor and eight right-hand sides in triangular
/// solutions, or for six columns of a basis and eight new ones in projections. A tile of n columns
/// holds [n x 6] numbers, by columns; X and Y hold a row of eight numbers for each column and each
/// row of the tile.
struct TileKernels {
  /// Y <- Y - tile X
  void (*subtract)(const double* tile, int n_columns, const double* X, double* Y);
  /// X <- X - tile^T Y
  void (*subtract_transposed)(const double* tile, int n_columns, const double* Y, double* X);
  /// Y <- Y - V^T X, with rows of eight numbers in X, and V [n x 6] of leading dimension ld by
  /// columns.
  void (*subtract_tall)(const double* V, std::ptrdiff_t ld, int n, const double* X, double* Y);
  /// X <- X - V Y
  void (*subtract_tall_transposed)(const double* V, std::ptrdiff_t ld, int n, const double* Y,
                                   double* X);
  /// Y <- L^-1 Y; L [6 x 6] by rows with a unit diagonal, which is not read.
  void (*solve)(const double* L, double* Y);
  /// Y <- L^-T Y
  void (*solve_transposed)(const double* L, double* Y);
};

/// The kernels for the processor at hand.
const TileKernels& tile_kernels();

/// The kernels for any processor.
const TileKernels& portable_tile_kernels();

}  // namespace chladni::linear
