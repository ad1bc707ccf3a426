#pragma once

#include <cstddef>
#include <cstring>
#include <span>

#include "common/petsc.hpp"
#include "linear/kernels/dense_matrices.hpp"

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

/// The rows of this rank of some vectors, stored by columns.
struct LongColumns {
  const double* values;
  std::ptrdiff_t leading_dimension;
  PetscInt n_rows;
  PetscInt n_columns;
};

/// X^T Y of the rows of this rank, for long columns X and few Y. X is read once and, from six
/// columns on, not copied, as it would be by a general matrix product.
Eigen::MatrixXd tall_inner_product(const LongColumns& X, const LongColumns& Y);

/// Y <- Y - X S for few long columns Y.
void subtract_tall_product(const LongColumns& X, const Eigen::MatrixXd& S, double* Y,
                           std::ptrdiff_t leading_dimension);

/// Y <- X S for few long columns Y, which X does not share.
void tall_product(const LongColumns& X, const Eigen::MatrixXd& S, double* Y,
                  std::ptrdiff_t leading_dimension);

/// As many numbers side by side as the instructions of a processor take at once: GCC moves the
/// numbers of a wider vector one by one, by way of the stack.
template <int numbers>
struct Lane;
template <>
struct Lane<2> {
  double __attribute__((vector_size(16))) values;
};
template <>
struct Lane<4> {
  double __attribute__((vector_size(32))) values;
};
template <>
struct Lane<8> {
  double __attribute__((vector_size(64))) values;
};

template <int numbers>
[[gnu::always_inline]] inline void load(const double* from, Lane<numbers>& lane)
{
  std::memcpy(&lane.values, from, sizeof(lane.values));
}

template <int numbers>
[[gnu::always_inline]] inline void store(const Lane<numbers>& lane, double* to)
{
  std::memcpy(to, &lane.values, sizeof(lane.values));
}

#ifdef __x86_64__

template <typename Work>
[[gnu::target("avx512f"), gnu::flatten]] void on_lanes_of_8(const Work& work)
{
  work.template operator()<8>();
}

template <typename Work>
[[gnu::target("avx2,fma"), gnu::flatten]] void on_lanes_of_4(const Work& work)
{
  work.template operator()<4>();
}

#endif

template <typename Work>
[[gnu::flatten]] void on_lanes_of_2(const Work& work)
{
  work.template operator()<2>();
}

/// Numbers in the widest lane of the processor at hand: 8, 4, or the 2 of Debian's baseline.
int numbers_in_lane();

/// Lets narrower lanes be taken, to try what other processors do.
/// @return those that are taken from now on
int limit_lanes(int most);

/// Calls work.operator()<numbers>(), compiled for the processor at hand, with that many numbers in
/// its widest lane.
template <typename Work>
void on_widest_lanes(const Work& work)
{
#ifdef __x86_64__
  if (numbers_in_lane() == 8) return on_lanes_of_8(work);
  if (numbers_in_lane() == 4) return on_lanes_of_4(work);
#endif
  on_lanes_of_2(work);
}

/// Which rows of some columns stand where in a panel.
struct PanelRows {
  PetscInt n;
  const int* rows = nullptr;   ///< of the columns; null: 0 to n - 1
  const int* slots = nullptr;  ///< rows of the panel; null: 0 to n - 1
};

/// Copies rows of columns into a panel, which holds the numbers of a row side by side.
/// @param width  numbers in a row of the panel, a multiple of 8; those that there is no column for
///               become zero
void to_panel(std::span<const double* const> columns, const PanelRows& rows, PetscInt width,
              double* panel);

/// Copies rows of a panel back into columns.
void to_columns(const double* panel, PetscInt width, const PanelRows& rows,
                std::span<double* const> columns);

}  // namespace chladni::linear
