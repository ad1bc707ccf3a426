#include "linear/cholesky/supernodal/tiled_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "linear/kernels/panel_kernels.hpp"

namespace chladni::linear {

namespace {

constexpr int triangle_size = tile_rows * tile_rows;

int n_tiles(int n_rows)
{
  return (n_rows + tile_rows - 1) / tile_rows;
}

constexpr std::size_t rows_size = std::size_t(tile_rows) * panel_width;

/// Six rows of eight numbers each.
struct alignas(64) TileRows {
  std::array<double, rows_size> values;
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

namespace {

/// A tile of this rank, and its values.
struct OwnTile {
  RowTile rows;
  const double* values;

  const double* inverse_pivots() const { return values + std::size_t(rows.n_columns) * tile_rows; }
};

std::size_t size_of_tile(const RowTile& tile, bool is_pivot)
{
  return std::size_t(tile.n_columns + (is_pivot ? 1 : 0)) * tile_rows;
}

struct OwnTiles {
  std::vector<OwnTile> pivots, below;
};

OwnTiles own_tiles(const SharedColumns& L)
{
  OwnTiles tiles;
  const double* values = L.values;
  L.rows.for_tiles(L.place, [&](const RowTile& tile) {
    const bool is_pivot = L.rows.is_pivot(tile);
    (is_pivot ? tiles.pivots : tiles.below).push_back({.rows = tile, .values = values});
    values += size_of_tile(tile, is_pivot);
  });
  return tiles;
}

std::span<const int> slots_of_tile(const SharedColumns& L, const RowTile& tile)
{
  return L.below.subspan(std::size_t(tile.first - L.rows.n_columns()), std::size_t(tile.n_rows));
}

/// The rows of its columns in a panel.
double* own_rows(const SharedColumns& L, Panels X, int panel)
{
  return X.values + panel * X.stride + std::size_t(L.first) * panel_width;
}

}  // namespace

DealtRows dealt_rows(const AssemblyTree& tree, int s, const RankGroup& group)
{
  return {tree.n_columns(s), tree.n_below[s], group, s};
}

std::size_t shared_size(const DealtRows& rows, int place)
{
  std::size_t size = 0;
  rows.for_tiles(place,
                 [&](const RowTile& tile) { size += size_of_tile(tile, rows.is_pivot(tile)); });
  return size;
}

void store_shared(const DealtRows& rows, int place, const double* own, const double* D,
                  double* values)
{
  const std::size_t ld = rows.count(place, 0, rows.n_rows());
  rows.for_tiles(place, [&](const RowTile& tile) {
    std::fill_n(values, size_of_tile(tile, rows.is_pivot(tile)), 0.0);
    for (int c = 0; c < tile.n_columns; ++c, values += tile_rows)
      std::copy_n(own + std::size_t(c) * ld, tile.n_rows, values);
    own += tile.n_rows;
    if (!rows.is_pivot(tile)) return;
    for (int i = 0; i < tile.n_rows; ++i) values[i] = 1.0 / D[tile.first + i];
    values += tile_rows;
  });
}

void solve_forward(const SharedColumns& L, Panels X)
{
  const TileKernels& kernels = tile_kernels();
  const OwnTiles tiles = own_tiles(L);
  TileRows rows;
  const auto product = [&](const OwnTile& tile, int p) {  // its negative
    rows.values.fill(0.0);
    kernels.subtract(tile.values, tile.rows.n_columns, own_rows(L, X, p), rows.values.data());
  };
  for (const OwnTile& tile : tiles.below) {
    for (int p = 0; p < X.n_panels; ++p) {
      product(tile, p);
      const double* from = rows.values.data();
      for (const int slot : slots_of_tile(L, tile.rows)) {
        double* x = X.values + p * X.stride + std::size_t(slot) * panel_width;
        for (int k = 0; k < panel_width; ++k) x[k] += from[k];
        from += panel_width;
      }
    }
  }
  // From the last row up: each needs those above it as they were.
  int behind = L.rows.n_columns();
  const auto clear = [&](double* own, int first, int last) {
    std::fill(own + std::size_t(first) * panel_width, own + std::size_t(last) * panel_width, 0.0);
  };
  for (auto tile = tiles.pivots.rbegin(); tile != tiles.pivots.rend(); ++tile) {
    const int first = tile->rows.first, last = first + tile->rows.n_rows;
    for (int p = 0; p < X.n_panels; ++p) {
      double* own = own_rows(L, X, p);
      product(*tile, p);
      for (int i = 0; i < tile->rows.n_rows * panel_width; ++i)
        own[std::size_t(first) * panel_width + i] = -rows.values[i];
      clear(own, last, behind);
    }
    behind = first;
  }
  for (int p = 0; p < X.n_panels; ++p) clear(own_rows(L, X, p), 0, behind);
}

void solve_backward(const SharedColumns& L, Panels X)
{
  const TileKernels& kernels = tile_kernels();
  const OwnTiles tiles = own_tiles(L);
  TileRows rows;
  const auto add_product = [&](const OwnTile& tile, int p) {  // with the transposed tile
    kernels.subtract_transposed(tile.values, tile.rows.n_columns, rows.values.data(),
                                own_rows(L, X, p));
  };
  // From the first row down: each adds to those above it, which have become sums.
  for (const OwnTile& tile : tiles.pivots) {
    for (int p = 0; p < X.n_panels; ++p) {
      rows.values.fill(0.0);
      double* x = own_rows(L, X, p) + std::size_t(tile.rows.first) * panel_width;
      for (int i = 0; i < tile.rows.n_rows; ++i) {
        for (int k = 0; k < panel_width; ++k, ++x) {
          rows.values[i * panel_width + k] = -tile.inverse_pivots()[i] * *x;
          *x = 0.0;
        }
      }
      add_product(tile, p);
    }
  }
  for (const OwnTile& tile : tiles.below) {
    for (int p = 0; p < X.n_panels; ++p) {
      rows.values.fill(0.0);
      double* to = rows.values.data();
      for (const int slot : slots_of_tile(L, tile.rows)) {
        std::copy_n(X.values + p * X.stride + std::size_t(slot) * panel_width, panel_width, to);
        to += panel_width;
      }
      add_product(tile, p);
    }
  }
}

void scale_by_root(const SharedColumns& L, Panels X)
{
  for (const OwnTile& tile : own_tiles(L).pivots) {
    for (int i = 0; i < tile.rows.n_rows; ++i) {
      const double by = std::sqrt(tile.inverse_pivots()[i]);
      for (int p = 0; p < X.n_panels; ++p) {
        double* x = own_rows(L, X, p) + std::size_t(tile.rows.first + i) * panel_width;
        for (int k = 0; k < panel_width; ++k) x[k] *= by;
      }
    }
  }
}

}  // namespace chladni::linear
