#include "linear/kernels/panel_kernels.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "linear/kernels/storage.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace chladni::linear {

using Eigen::MatrixXd;

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

namespace {

constexpr PetscInt chunk_rows = 256;  // eight columns of them take half of a first-level cache

/// n rows of at most eight long columns side by side, and zeros for those that there are not.
void pack_panel(const double* columns, std::ptrdiff_t ld, PetscInt n, PetscInt n_columns,
                double* rows)
{
  std::array<const double*, panel_width> from{};
  for (PetscInt c = 0; c < n_columns; ++c) from[std::size_t(c)] = columns + c * ld;
  to_panel(std::span(from).first(std::size_t(n_columns)), {.n = n}, panel_width, rows);
}

void unpack_panel(const double* rows, PetscInt n, PetscInt n_columns, double* columns,
                  std::ptrdiff_t ld)
{
  std::array<double*, panel_width> to{};
  for (PetscInt c = 0; c < n_columns; ++c) to[std::size_t(c)] = columns + c * ld;
  to_columns(rows, panel_width, {.n = n}, std::span(to).first(std::size_t(n_columns)));
}

/// work(first row, number of rows) of each chunk.
template <typename Work>
void for_chunks(PetscInt n_rows, const Work& work)
{
  for (PetscInt first = 0; first < n_rows; first += chunk_rows)
    work(first, std::min(chunk_rows, n_rows - first));
}

/// Long columns six at a time. Where their number is not a multiple of six, the last six come once
/// more, and where there are fewer, zeros beside them.
class Tiles {
 public:
  static constexpr std::size_t size = std::size_t(tile_rows) * panel_width;  ///< of its sums

  explicit Tiles(const LongColumns& X) : X_(X)
  {
    if (X.n_columns > 0 && X.n_columns < tile_rows)
      filled_up_.resize(std::size_t(chunk_rows) * tile_rows, 0.0);
  }

  PetscInt n() const { return (X_.n_columns + tile_rows - 1) / tile_rows; }
  /// The first column of a tile.
  PetscInt first(PetscInt tile) const
  {
    return std::min<PetscInt>(tile * tile_rows, std::max<PetscInt>(X_.n_columns - tile_rows, 0));
  }
  /// Places in a tile whose columns are in none before it.
  std::pair<PetscInt, PetscInt> own_places(PetscInt tile) const
  {
    return {tile * tile_rows - first(tile),
            std::min<PetscInt>(X_.n_columns - first(tile), tile_rows)};
  }

  /// work(tile, its values in rows first to first + n - 1, their leading dimension)
  template <typename Work>
  void for_each(PetscInt first_row, PetscInt n_rows, const Work& work)
  {
    const double* values = X_.values + first_row;
    if (filled_up_.empty()) {
      for (PetscInt t = 0; t < n(); ++t)
        work(t, values + first(t) * X_.leading_dimension, X_.leading_dimension);
      return;
    }
    for (PetscInt c = 0; c < X_.n_columns; ++c)
      std::copy_n(values + c * X_.leading_dimension, n_rows, filled_up_.begin() + c * chunk_rows);
    work(0, filled_up_.data(), std::ptrdiff_t(chunk_rows));
  }

 private:
  LongColumns X_;
  std::vector<double> filled_up_;  ///< [chunk_rows x 6] by columns
};

PetscInt n_panels_over(Eigen::Index n_columns)
{
  return static_cast<PetscInt>((n_columns + panel_width - 1) / panel_width);
}

/// The columns of a panel.
std::pair<PetscInt, PetscInt> columns_of_panel(PetscInt panel, Eigen::Index n_columns)
{
  const PetscInt first = panel * panel_width;
  return {first, static_cast<PetscInt>(std::min<Eigen::Index>(panel_width, n_columns - first))};
}

enum class Before { kept, overwritten };

/// Y <- Y - X S, or Y <- -X S.
void subtract(const LongColumns& X, const MatrixXd& S, Before before, double* Y,
              std::ptrdiff_t leading_dimension)
{
  const TileKernels& kernels = tile_kernels();
  Tiles tiles(X);
  const PetscInt panels = n_panels_over(S.cols());
  const std::size_t panel_size = std::size_t(chunk_rows) * panel_width;
  const AlignedNumbers rows = aligned_numbers(panel_size * std::size_t(panels));
  const std::size_t n_factors = std::size_t(tiles.n()) * Tiles::size;
  const AlignedNumbers factors = aligned_numbers(n_factors * std::size_t(panels));
  std::fill_n(factors.get(), n_factors * std::size_t(panels), 0.0);
  const auto factors_of = [&](PetscInt tile, PetscInt panel) {
    return factors.get() + std::size_t(panel) * n_factors + std::size_t(tile) * Tiles::size;
  };
  for (Eigen::Index j = 0; j < S.cols(); ++j) {
    for (PetscInt t = 0; t < tiles.n(); ++t) {
      double* column = factors_of(t, static_cast<PetscInt>(j / panel_width)) + j % panel_width;
      const auto [begin, end] = tiles.own_places(t);
      for (PetscInt i = begin; i < end; ++i) column[i * panel_width] = S(tiles.first(t) + i, j);
    }
  }
  for_chunks(X.n_rows, [&](PetscInt first, PetscInt n) {
    const auto panel_of = [&](PetscInt p) { return rows.get() + std::size_t(p) * panel_size; };
    const auto columns = [&](PetscInt j) { return Y + first + j * leading_dimension; };
    for (PetscInt p = 0; p < panels; ++p) {
      const auto [j, width] = columns_of_panel(p, S.cols());
      if (before == Before::kept)
        pack_panel(columns(j), leading_dimension, n, width, panel_of(p));
      else
        std::fill_n(panel_of(p), std::size_t(n) * panel_width, 0.0);
    }
    tiles.for_each(first, n, [&](PetscInt t, const double* values, std::ptrdiff_t ld) {
      for (PetscInt p = 0; p < panels; ++p)
        kernels.subtract_tall_transposed(values, ld, n, factors_of(t, p), panel_of(p));
    });
    for (PetscInt p = 0; p < panels; ++p) {
      const auto [j, width] = columns_of_panel(p, S.cols());
      unpack_panel(panel_of(p), n, width, columns(j), leading_dimension);
    }
  });
}

}  // namespace

MatrixXd tall_inner_product(const LongColumns& X, const LongColumns& Y)
{
  const TileKernels& kernels = tile_kernels();
  Tiles tiles(X);
  const PetscInt panels = n_panels_over(Y.n_columns);
  const std::size_t panel_size = std::size_t(chunk_rows) * panel_width;
  const std::size_t n_sums = std::size_t(tiles.n()) * Tiles::size;
  const AlignedNumbers rows = aligned_numbers(panel_size * std::size_t(panels));
  const AlignedNumbers sums = aligned_numbers(n_sums * std::size_t(panels));
  // Sums over a million rows one after the other would lose a digit more than sums of sums.
  constexpr PetscInt rows_of_sum = 32 * chunk_rows;
  std::vector<double> totals(n_sums * std::size_t(panels), 0.0);
  std::fill_n(sums.get(), totals.size(), 0.0);
  const auto place_of = [&](PetscInt tile, PetscInt panel) {
    return std::size_t(panel) * n_sums + std::size_t(tile) * Tiles::size;
  };
  for_chunks(X.n_rows, [&](PetscInt first, PetscInt n) {
    const auto panel_of = [&](PetscInt p) { return rows.get() + std::size_t(p) * panel_size; };
    for (PetscInt p = 0; p < panels; ++p) {
      const auto [j, width] = columns_of_panel(p, Y.n_columns);
      pack_panel(Y.values + first + j * Y.leading_dimension, Y.leading_dimension, n, width,
                 panel_of(p));
    }
    tiles.for_each(first, n, [&](PetscInt t, const double* values, std::ptrdiff_t ld) {
      for (PetscInt p = 0; p < panels; ++p)
        kernels.subtract_tall(values, ld, n, panel_of(p), sums.get() + place_of(t, p));
    });
    if ((first + n) % rows_of_sum != 0 && first + n != X.n_rows) return;
    for (std::size_t i = 0; i < totals.size(); ++i) totals[i] += sums.get()[i];
    std::fill_n(sums.get(), totals.size(), 0.0);
  });
  MatrixXd product = MatrixXd::Zero(X.n_columns, Y.n_columns);
  for (PetscInt j = 0; j < Y.n_columns; ++j) {
    for (PetscInt t = 0; t < tiles.n(); ++t) {
      const double* sum = totals.data() + place_of(t, j / panel_width) + j % panel_width;
      const auto [begin, end] = tiles.own_places(t);
      for (PetscInt i = begin; i < end; ++i) product(tiles.first(t) + i, j) = -sum[i * panel_width];
    }
  }
  return product;
}

void subtract_tall_product(const LongColumns& X, const MatrixXd& S, double* Y,
                           std::ptrdiff_t leading_dimension)
{
  subtract(X, S, Before::kept, Y, leading_dimension);
}

void tall_product(const LongColumns& X, const MatrixXd& S, double* Y,
                  std::ptrdiff_t leading_dimension)
{
  subtract(X, -S, Before::overwritten, Y, leading_dimension);
}

}  // namespace chladni::linear
