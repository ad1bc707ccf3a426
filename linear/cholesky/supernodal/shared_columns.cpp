#include "linear/cholesky/supernodal/shared_columns.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "linear/kernels/tile_kernels.hpp"

namespace chladni::linear {

namespace {

constexpr std::size_t rows_size = std::size_t(tile_rows) * panel_width;

/// Six rows of eight numbers each.
struct alignas(64) TileRows {
  std::array<double, rows_size> values;
};

/// A tile of this rank, and its values.
struct OwnTile {
  RowTile rows;
  const double* values;

  const double* inverse_pivots() const { return values + std::size_t(rows.n_columns) * tile_rows; }
};

std::size_t size_of(const RowTile& tile, bool is_pivot)
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
    values += size_of(tile, is_pivot);
  });
  return tiles;
}

std::span<const int> rows_of(const SharedColumns& L, const RowTile& tile)
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
  rows.for_tiles(place, [&](const RowTile& tile) { size += size_of(tile, rows.is_pivot(tile)); });
  return size;
}

void store_shared(const DealtRows& rows, int place, const double* own, const double* D,
                  double* values)
{
  const std::size_t ld = rows.count(place, 0, rows.n_rows());
  rows.for_tiles(place, [&](const RowTile& tile) {
    std::fill_n(values, size_of(tile, rows.is_pivot(tile)), 0.0);
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
      for (const int slot : rows_of(L, tile.rows)) {
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
      for (const int slot : rows_of(L, tile.rows)) {
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
