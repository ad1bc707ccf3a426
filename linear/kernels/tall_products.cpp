#include "linear/kernels/tall_products.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "linear/kernels/aligned_numbers.hpp"
#include "linear/kernels/panel_columns.hpp"
#include "linear/kernels/tile_kernels.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

constexpr PetscInt chunk_rows = 256;  // with eight columns half of a first-level cache

/// n rows of at most eight long columns side by side, and zeros for those that there are not.
void pack(const double* columns, std::ptrdiff_t ld, PetscInt n, PetscInt n_columns, double* rows)
{
  std::array<const double*, panel_width> from{};
  for (PetscInt c = 0; c < n_columns; ++c) from[std::size_t(c)] = columns + c * ld;
  to_panel(std::span(from).first(std::size_t(n_columns)), {.n = n}, panel_width, rows);
}

void unpack(const double* rows, PetscInt n, PetscInt n_columns, double* columns, std::ptrdiff_t ld)
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

/// What the tiles leave: fewer than six columns.
PetscInt tiled_columns(const LongColumns& X)
{
  return X.n_columns / tile_rows * tile_rows;
}

}  // namespace

MatrixXd tall_inner_product(const LongColumns& X, const LongColumns& Y)
{
  const TileKernels& kernels = tile_kernels();
  MatrixXd product = MatrixXd::Zero(X.n_columns, Y.n_columns);
  const AlignedNumbers rows = aligned_numbers(std::size_t(chunk_rows) * panel_width);
  const AlignedNumbers sums = aligned_numbers(std::size_t(X.n_columns) * panel_width);
  for (PetscInt j = 0; j < Y.n_columns; j += panel_width) {
    const PetscInt width = std::min<PetscInt>(panel_width, Y.n_columns - j);
    std::fill_n(sums.get(), std::size_t(X.n_columns) * panel_width, 0.0);
    for_chunks(X.n_rows, [&](PetscInt first, PetscInt n) {
      pack(Y.values + first + j * Y.leading_dimension, Y.leading_dimension, n, width, rows.get());
      for (PetscInt c = 0; c < tiled_columns(X); c += tile_rows) {
        kernels.subtract_tall(X.values + first + c * X.leading_dimension, X.leading_dimension, n,
                              rows.get(), sums.get() + std::size_t(c) * panel_width);
      }
      for (PetscInt c = tiled_columns(X); c < X.n_columns; ++c) {
        const double* x = X.values + first + c * X.leading_dimension;
        double* sum = sums.get() + std::size_t(c) * panel_width;
        for (PetscInt i = 0; i < n; ++i)
          for (PetscInt k = 0; k < panel_width; ++k)
            sum[k] -= x[i] * rows.get()[i * panel_width + k];
      }
    });
    for (PetscInt k = 0; k < width; ++k)
      for (PetscInt i = 0; i < X.n_columns; ++i)
        product(i, j + k) = -sums.get()[std::size_t(i) * panel_width + k];
  }
  return product;
}

void subtract_tall_product(const LongColumns& X, const MatrixXd& S, double* Y,
                           std::ptrdiff_t leading_dimension)
{
  const TileKernels& kernels = tile_kernels();
  const AlignedNumbers rows = aligned_numbers(std::size_t(chunk_rows) * panel_width);
  const AlignedNumbers factors = aligned_numbers(std::size_t(X.n_columns) * panel_width);
  for (PetscInt j = 0; j < S.cols(); j += panel_width) {
    const PetscInt width = static_cast<PetscInt>(std::min<Eigen::Index>(panel_width, S.cols() - j));
    pack(S.data() + j * S.rows(), S.rows(), static_cast<PetscInt>(S.rows()), width, factors.get());
    for_chunks(X.n_rows, [&](PetscInt first, PetscInt n) {
      double* y = Y + first + j * leading_dimension;
      pack(y, leading_dimension, n, width, rows.get());
      for (PetscInt c = 0; c < tiled_columns(X); c += tile_rows) {
        kernels.subtract_tall_transposed(X.values + first + c * X.leading_dimension,
                                         X.leading_dimension, n,
                                         factors.get() + std::size_t(c) * panel_width, rows.get());
      }
      for (PetscInt c = tiled_columns(X); c < X.n_columns; ++c) {
        const double* x = X.values + first + c * X.leading_dimension;
        const double* factor = factors.get() + std::size_t(c) * panel_width;
        for (PetscInt i = 0; i < n; ++i)
          for (PetscInt k = 0; k < panel_width; ++k)
            rows.get()[i * panel_width + k] -= x[i] * factor[k];
      }
      unpack(rows.get(), n, width, y, leading_dimension);
    });
  }
}

}  // namespace chladni::linear
