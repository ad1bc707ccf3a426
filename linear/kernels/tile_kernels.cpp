#include "linear/kernels/tile_kernels.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace chladni::linear {

namespace {

// How a tile of six rows stands in memory: column after column, or as six long columns of a matrix.
// The processor asks for what follows by itself, but not beyond a page, and of six columns at once
// too late; asking ahead makes solutions and projections a fifth faster.

struct Packed {
  static constexpr std::ptrdiff_t row() { return 1; }
  static constexpr std::ptrdiff_t column() { return tile_rows; }
  /// What to ask for at a column: there are as many as lines of eight numbers, or more.
  static const double* ahead(const double* tile, int /*column*/)
  {
    constexpr std::ptrdiff_t distance = 384;
    return tile + distance;
  }
};

struct Tall {
  std::ptrdiff_t leading_dimension;
  std::ptrdiff_t row() const { return leading_dimension; }
  static constexpr std::ptrdiff_t column() { return 1; }
  /// A line of one of the six at each of eight numbers.
  const double* ahead(const double* tile, int column) const
  {
    constexpr std::ptrdiff_t distance = 64;
    const int next = column % panel_width;
    return tile + distance + (next < tile_rows ? next : 0) * leading_dimension;
  }
};

namespace portable {

template <typename Strides>
void subtract_any(const double* tile, Strides strides, int n_columns, const double* X, double* Y)
{
  for (int c = 0; c < n_columns; ++c, tile += strides.column(), X += panel_width) {
    for (int r = 0; r < tile_rows; ++r)
      for (int k = 0; k < panel_width; ++k)
        Y[r * panel_width + k] -= tile[r * strides.row()] * X[k];
  }
}

template <typename Strides>
void subtract_any_transposed(const double* tile, Strides strides, int n_columns, const double* Y,
                             double* X)
{
  for (int c = 0; c < n_columns; ++c, tile += strides.column(), X += panel_width) {
    for (int r = 0; r < tile_rows; ++r)
      for (int k = 0; k < panel_width; ++k)
        X[k] -= tile[r * strides.row()] * Y[r * panel_width + k];
  }
}

void subtract(const double* tile, int n_columns, const double* X, double* Y)
{
  subtract_any(tile, Packed{}, n_columns, X, Y);
}

void subtract_transposed(const double* tile, int n_columns, const double* Y, double* X)
{
  subtract_any_transposed(tile, Packed{}, n_columns, Y, X);
}

void subtract_tall(const double* V, std::ptrdiff_t ld, int n, const double* X, double* Y)
{
  subtract_any(V, Tall{ld}, n, X, Y);
}

void subtract_tall_transposed(const double* V, std::ptrdiff_t ld, int n, const double* Y, double* X)
{
  subtract_any_transposed(V, Tall{ld}, n, Y, X);
}

void solve(const double* L, double* Y)
{
  for (int i = 0; i < tile_rows; ++i) {
    double* y = Y + i * panel_width;
    for (int j = 0; j < i; ++j)
      for (int k = 0; k < panel_width; ++k) y[k] -= L[i * tile_rows + j] * Y[j * panel_width + k];
  }
}

void solve_transposed(const double* L, double* Y)
{
  for (int i = tile_rows - 1; i >= 0; --i) {
    const double* y = Y + i * panel_width;
    for (int j = 0; j < i; ++j)
      for (int k = 0; k < panel_width; ++k) Y[j * panel_width + k] -= L[i * tile_rows + j] * y[k];
  }
}

constexpr TileKernels kernels{subtract,      subtract_transposed,
                              subtract_tall, subtract_tall_transposed,
                              solve,         solve_transposed};

}  // namespace portable

#ifdef __x86_64__
namespace avx2 {

// NOLINTBEGIN(modernize-avoid-c-arrays): registers

template <typename Strides>
[[gnu::target("avx2,fma")]] void subtract_any(const double* tile, Strides strides, int n_columns,
                                              const double* X, double* Y)
{
  __m256d left[tile_rows], right[tile_rows];
#pragma GCC unroll 6
  for (int r = 0; r < tile_rows; ++r) {
    left[r] = _mm256_loadu_pd(Y + r * panel_width);
    right[r] = _mm256_loadu_pd(Y + r * panel_width + 4);
  }
  for (int c = 0; c < n_columns; ++c, tile += strides.column(), X += panel_width) {
    __builtin_prefetch(strides.ahead(tile, c));
    const __m256d x_left = _mm256_loadu_pd(X), x_right = _mm256_loadu_pd(X + 4);
#pragma GCC unroll 6
    for (int r = 0; r < tile_rows; ++r) {
      const __m256d factor = _mm256_broadcast_sd(tile + r * strides.row());
      left[r] = _mm256_fnmadd_pd(factor, x_left, left[r]);
      right[r] = _mm256_fnmadd_pd(factor, x_right, right[r]);
    }
  }
#pragma GCC unroll 6
  for (int r = 0; r < tile_rows; ++r) {
    _mm256_storeu_pd(Y + r * panel_width, left[r]);
    _mm256_storeu_pd(Y + r * panel_width + 4, right[r]);
  }
}

template <typename Strides>
[[gnu::target("avx2,fma")]] void subtract_any_transposed(const double* tile, Strides strides,
                                                         int n_columns, const double* Y, double* X)
{
  __m256d left[tile_rows], right[tile_rows];
#pragma GCC unroll 6
  for (int r = 0; r < tile_rows; ++r) {
    left[r] = _mm256_loadu_pd(Y + r * panel_width);
    right[r] = _mm256_loadu_pd(Y + r * panel_width + 4);
  }
  for (int c = 0; c < n_columns; ++c, tile += strides.column(), X += panel_width) {
    __builtin_prefetch(strides.ahead(tile, c));
    __m256d x_left = _mm256_loadu_pd(X), x_right = _mm256_loadu_pd(X + 4);
#pragma GCC unroll 6
    for (int r = 0; r < tile_rows; ++r) {
      const __m256d factor = _mm256_broadcast_sd(tile + r * strides.row());
      x_left = _mm256_fnmadd_pd(factor, left[r], x_left);
      x_right = _mm256_fnmadd_pd(factor, right[r], x_right);
    }
    _mm256_storeu_pd(X, x_left);
    _mm256_storeu_pd(X + 4, x_right);
  }
}

[[gnu::target("avx2,fma")]] void subtract(const double* tile, int n_columns, const double* X,
                                          double* Y)
{
  subtract_any(tile, Packed{}, n_columns, X, Y);
}

[[gnu::target("avx2,fma")]] void subtract_transposed(const double* tile, int n_columns,
                                                     const double* Y, double* X)
{
  subtract_any_transposed(tile, Packed{}, n_columns, Y, X);
}

[[gnu::target("avx2,fma")]] void subtract_tall(const double* V, std::ptrdiff_t ld, int n,
                                               const double* X, double* Y)
{
  subtract_any(V, Tall{ld}, n, X, Y);
}

[[gnu::target("avx2,fma")]] void subtract_tall_transposed(const double* V, std::ptrdiff_t ld, int n,
                                                          const double* Y, double* X)
{
  subtract_any_transposed(V, Tall{ld}, n, Y, X);
}

[[gnu::target("avx2,fma")]] void solve(const double* L, double* Y)
{
  __m256d left[tile_rows], right[tile_rows];
#pragma GCC unroll 6
  for (int i = 0; i < tile_rows; ++i) {
    left[i] = _mm256_loadu_pd(Y + i * panel_width);
    right[i] = _mm256_loadu_pd(Y + i * panel_width + 4);
#pragma GCC unroll 6
    for (int j = 0; j < i; ++j) {
      const __m256d factor = _mm256_broadcast_sd(L + i * tile_rows + j);
      left[i] = _mm256_fnmadd_pd(factor, left[j], left[i]);
      right[i] = _mm256_fnmadd_pd(factor, right[j], right[i]);
    }
    _mm256_storeu_pd(Y + i * panel_width, left[i]);
    _mm256_storeu_pd(Y + i * panel_width + 4, right[i]);
  }
}

[[gnu::target("avx2,fma")]] void solve_transposed(const double* L, double* Y)
{
  __m256d left[tile_rows], right[tile_rows];
#pragma GCC unroll 6
  for (int i = 0; i < tile_rows; ++i) {
    left[i] = _mm256_loadu_pd(Y + i * panel_width);
    right[i] = _mm256_loadu_pd(Y + i * panel_width + 4);
  }
#pragma GCC unroll 6
  for (int i = tile_rows - 1; i >= 0; --i) {
#pragma GCC unroll 6
    for (int j = 0; j < i; ++j) {
      const __m256d factor = _mm256_broadcast_sd(L + i * tile_rows + j);
      left[j] = _mm256_fnmadd_pd(factor, left[i], left[j]);
      right[j] = _mm256_fnmadd_pd(factor, right[i], right[j]);
    }
    _mm256_storeu_pd(Y + i * panel_width, left[i]);
    _mm256_storeu_pd(Y + i * panel_width + 4, right[i]);
  }
}

// NOLINTEND(modernize-avoid-c-arrays)

constexpr TileKernels kernels{subtract,      subtract_transposed,
                              subtract_tall, subtract_tall_transposed,
                              solve,         solve_transposed};

}  // namespace avx2
#endif

}  // namespace

const TileKernels& tile_kernels()
{
#ifdef __x86_64__
  static const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (has_avx2) return avx2::kernels;
#endif
  return portable_tile_kernels();
}

const TileKernels& portable_tile_kernels()
{
  return portable::kernels;
}

}  // namespace chladni::linear
