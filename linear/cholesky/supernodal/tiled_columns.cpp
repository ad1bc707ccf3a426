#include "linear/cholesky/supernodal/tiled_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "linear/kernels/tile_kernels.hpp"

namespace chladni::linear {

namespace {

constexpr int triangle_size = tile_rows * tile_rows;

int n_tiles(int n_rows)
{
  return (n_rows + tile_rows - 1) / tile_rows;
}

/// Six rows of eight numbers each.
struct alignas(64) TileRows {
  std::array<double, std::size_t(tile_rows) * panel_width> values;
};

/// Rows of a panel that stand together; zeros fill up.
void load(const double* rows, int n, TileRows& to)
{
  std::copy_n(rows, n * panel_width, to.values.begin());
  std::fill(to.values.begin() + n * panel_width, to.values.end(), 0.0);
}

/// Up to six numbers of a column, and zeros for those that there are not.
void copy_column(const double* column, int n, double* to)
{
  if (n == tile_rows) {  // of a known number, which needs no call
    std::copy_n(column, tile_rows, to);
    return;
  }
  std::copy_n(column, n, to);
  std::fill(to + n, to + tile_rows, 0.0);
}

/// The rows below that belong to tile t.
std::span<const int> rows_of_tile(std::span<const int> below, int t)
{
  const std::size_t first = std::size_t(t) * tile_rows;
  return below.subspan(first, std::min<std::size_t>(tile_rows, below.size() - first));
}

}  // namespace

std::size_t tiled_size(int n_columns, int n_below)
{
  const std::size_t n_diagonal = n_tiles(n_columns), n_under = n_tiles(n_below);
  return n_diagonal * (n_diagonal - 1) / 2 * triangle_size + n_diagonal * triangle_size +
         n_under * tile_rows * std::size_t(n_columns);
}

void store_tiles(const double* columns, int n_columns, int n_below, double* tiles)
{
  const std::size_t ld = std::size_t(n_columns) + n_below;
  for (int first = 0; first < n_columns; first += tile_rows) {
    const int n = std::min(tile_rows, n_columns - first);
    for (int c = 0; c < first; ++c, tiles += tile_rows)
      copy_column(columns + c * ld + first, n, tiles);
    std::fill_n(tiles, triangle_size, 0.0);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) tiles[i * tile_rows + j] = columns[(first + j) * ld + first + i];
      tiles[i * tile_rows + i] = 1.0 / columns[(first + i) * ld + first + i];
    }
    tiles += triangle_size;
  }
  for (int first = 0; first < n_below; first += tile_rows) {
    const int n = std::min(tile_rows, n_below - first);
    for (int c = 0; c < n_columns; ++c, tiles += tile_rows)
      copy_column(columns + c * ld + n_columns + first, n, tiles);
  }
}

void solve_forward(const TiledColumns& L, Panels X)
{
  const TileKernels& kernels = tile_kernels();
  TileRows rows;
  const double* tile = L.values;
  for (int first = 0; first < L.n_columns; first += tile_rows) {
    const int n = std::min(tile_rows, L.n_columns - first);
    const double* triangle = tile + std::size_t(first) * tile_rows;
    for (int p = 0; p < X.n_panels; ++p) {
      double* own = X.values + p * X.stride + std::size_t(L.first) * panel_width;
      load(own + first * panel_width, n, rows);
      kernels.subtract(tile, first, own, rows.values.data());
      kernels.solve(triangle, rows.values.data());
      std::copy_n(rows.values.begin(), n * panel_width, own + first * panel_width);
    }
    tile = triangle + triangle_size;
  }
  for (int t = 0; t < n_tiles(static_cast<int>(L.below.size())); ++t) {
    const std::span<const int> below = rows_of_tile(L.below, t);
    for (int p = 0; p < X.n_panels; ++p) {
      double* panel = X.values + p * X.stride;
      rows.values.fill(0.0);
      kernels.subtract(tile, L.n_columns, panel + std::size_t(L.first) * panel_width,
                       rows.values.data());
      for (std::size_t i = 0; i < below.size(); ++i) {
        double* x = panel + std::size_t(below[i]) * panel_width;
        for (int k = 0; k < panel_width; ++k) x[k] += rows.values[i * panel_width + k];
      }
    }
    tile += std::size_t(L.n_columns) * tile_rows;
  }
}

namespace {

/// Multiplies each row of X in the columns of L by a factor made of the entry of D^-1.
template <typename Factor>
void scale(const TiledColumns& L, Panels X, const Factor& factor)
{
  const double* triangle = L.values;
  for (int first = 0; first < L.n_columns; first += tile_rows) {
    triangle += std::size_t(first) * tile_rows;
    for (int i = 0; i < std::min(tile_rows, L.n_columns - first); ++i) {
      const double by = factor(triangle[i * tile_rows + i]);
      for (int p = 0; p < X.n_panels; ++p) {
        double* x = X.values + p * X.stride + std::size_t(L.first + first + i) * panel_width;
        for (int k = 0; k < panel_width; ++k) x[k] *= by;
      }
    }
    triangle += triangle_size;
  }
}

}  // namespace

void scale_by_root(const TiledColumns& L, Panels X)
{
  scale(L, X, [](double inverse) { return std::sqrt(inverse); });
}

void solve_backward(const TiledColumns& L, Panels X)
{
  scale(L, X, [](double inverse) { return inverse; });
  const TileKernels& kernels = tile_kernels();
  TileRows rows;
  const auto n_below = static_cast<int>(L.below.size());
  const double* const behind_triangle = L.values + tiled_size(L.n_columns, 0);
  const double* tile = behind_triangle;
  for (int t = 0; t < n_tiles(n_below); ++t) {  // any order would do; memory likes this one
    const std::span<const int> below = rows_of_tile(L.below, t);
    for (int p = 0; p < X.n_panels; ++p) {
      double* panel = X.values + p * X.stride;
      rows.values.fill(0.0);
      for (std::size_t i = 0; i < below.size(); ++i) {
        std::copy_n(panel + std::size_t(below[i]) * panel_width, panel_width,
                    rows.values.begin() + i * panel_width);
      }
      kernels.subtract_transposed(tile, L.n_columns, rows.values.data(),
                                  panel + std::size_t(L.first) * panel_width);
    }
    tile += std::size_t(L.n_columns) * tile_rows;
  }
  tile = behind_triangle;
  for (int first = (n_tiles(L.n_columns) - 1) * tile_rows; first >= 0; first -= tile_rows) {
    const int n = std::min(tile_rows, L.n_columns - first);
    const double* triangle = tile - triangle_size;
    tile = triangle - std::size_t(first) * tile_rows;
    for (int p = 0; p < X.n_panels; ++p) {
      double* own = X.values + p * X.stride + std::size_t(L.first) * panel_width;
      load(own + first * panel_width, n, rows);
      kernels.solve_transposed(triangle, rows.values.data());
      std::copy_n(rows.values.begin(), n * panel_width, own + first * panel_width);
      kernels.subtract_transposed(tile, first, rows.values.data(), own);
    }
  }
}

}  // namespace chladni::linear
