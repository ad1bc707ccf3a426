#pragma once

namespace chladni::reduce {

inline constexpr int tile_rows = 6;    ///< six times eight sums fill the vector registers
inline constexpr int panel_width = 8;  ///< right-hand sides side by side: a cache line

/// What a triangular solution does with one tile of six rows of the factor and eight right-hand
/// sides. A tile of n columns holds [n x 6] numbers, column after column; X and Y hold a row of
/// eight numbers for each column and each row of the tile.
struct TileKernels {
  /// Y <- Y - tile X
  void (*subtract)(const double* tile, int n_columns, const double* X, double* Y);
  /// X <- X - tile^T Y
  void (*subtract_transposed)(const double* tile, int n_columns, const double* Y, double* X);
  /// Y <- L^-1 Y; L [6 x 6] by rows with ones on its diagonal, whatever is stored there.
  void (*solve)(const double* L, double* Y);
  /// Y <- L^-T Y
  void (*solve_transposed)(const double* L, double* Y);
};

/// For the processor at hand.
const TileKernels& tile_kernels();

}  // namespace chladni::reduce
