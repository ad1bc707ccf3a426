#include "linear/kernels/csr_rows.hpp"

#include <algorithm>

#include "linear/kernels/lanes.hpp"

namespace chladni::linear {

namespace {

/// Whether a product is added to what is there.
enum class Start { zero, there };

/// Asks for what comes behind some numbers that are about to be read, and as much of it.
template <typename Number>
[[gnu::always_inline]] inline void ask_ahead(const Number* numbers, PetscInt n)
{
  constexpr std::size_t distance = 2048, cache_line = 64;  // bytes
  for (std::size_t at = 0; at < std::size_t(n); at += cache_line / sizeof(Number))
    __builtin_prefetch(numbers + distance / sizeof(Number) + at);
}

/// `alike` rows of Y <- A panel, from row i on, which have the same columns: what they multiply is
/// read once.
template <int numbers, PetscInt width, int alike, Start start>
[[gnu::always_inline]] inline void multiply_rows(const Csr& A, PetscInt i, const double* panel,
                                                 double* Y)
{
  constexpr int n_lanes = width / numbers;
  // NOLINTBEGIN(modernize-avoid-c-arrays): sums that stay in registers
  Lane<numbers> sum[alike][n_lanes];
  const PetscScalar* values[alike];
  // NOLINTEND(modernize-avoid-c-arrays)
  double* y = Y + std::size_t(i) * width;
#pragma GCC unroll 8
  for (int r = 0; r < alike; ++r) {
    values[r] = A.values + A.starts[i + r];
#pragma GCC unroll 8
    for (int l = 0; l < n_lanes; ++l)
      if constexpr (start == Start::there)
        load(y + r * width + l * numbers, sum[r][l]);
      else
        sum[r][l] = Lane<numbers>{};
  }
  const PetscInt* columns = A.columns + A.starts[i];
  const PetscInt n = A.starts[i + 1] - A.starts[i];
  ask_ahead(values[0], alike * n);
  ask_ahead(columns, n);
  for (PetscInt k = 0; k < n; ++k) {
    const double* from = panel + std::size_t(columns[k]) * width;
#pragma GCC unroll 8
    for (int l = 0; l < n_lanes; ++l) {
      Lane<numbers> x;
      load(from + l * numbers, x);
#pragma GCC unroll 8
      for (int r = 0; r < alike; ++r) sum[r][l].values += values[r][k] * x.values;
    }
  }
#pragma GCC unroll 8
  for (int r = 0; r < alike; ++r)
#pragma GCC unroll 8
    for (int l = 0; l < n_lanes; ++l) store(sum[r][l], y + r * width + l * numbers);
}

constexpr int most_alike = 3;  // rows at a time: the sums of more have no registers

/// Y <- A panel in some rows, Y row by row like the panel. The entries are asked for ahead. What
/// it needs of the panel the processor asks for soon enough by itself: asking ahead took longer.
/// @param n_alike  [rows of A] how many from this one on have the same columns, up to `most_alike`
template <int numbers, PetscInt width>
[[gnu::always_inline]] inline void multiply_panel(const Csr& A, const char* n_alike,
                                                  const RowSpan& rows, const double* panel,
                                                  double* Y)
{
  for (PetscInt i = rows.first; i < rows.last;) {
    const PetscInt alike = std::min<PetscInt>(n_alike[i], rows.last - i);
    if (alike >= 3)
      multiply_rows<numbers, width, 3, Start::zero>(A, i, panel, Y);
    else if (alike == 2)
      multiply_rows<numbers, width, 2, Start::zero>(A, i, panel, Y);
    else
      multiply_rows<numbers, width, 1, Start::zero>(A, i, panel, Y);
    i += alike;
  }
}

/// Y <- Y + A panel in some rows.
template <int numbers, PetscInt width>
[[gnu::always_inline]] inline void add_panel(const Csr& A, const RowSpan& rows, const double* panel,
                                             double* Y)
{
  for (PetscInt i = rows.first; i < rows.last; ++i)
    multiply_rows<numbers, width, 1, Start::there>(A, i, panel, Y);
}

/// Rows at which a square matrix may be cut: no entry joins those before with the others.
std::vector<char> free_cuts(const Csr& A, PetscInt n)
{
  std::vector<char> is_free(std::size_t(n), 0);
  std::vector<PetscInt> nearest(std::size_t(n), n);  // column of each row
  PetscInt farthest = 0;
  for (PetscInt i = 0; i < n; ++i) {
    is_free[std::size_t(i)] = farthest <= i ? 1 : 0;
    const std::span<const PetscInt> row = A.row(i);
    if (row.empty()) continue;
    const auto [least, most] = std::ranges::minmax(row);
    farthest = std::max(farthest, most + 1);
    nearest[std::size_t(i)] = least;
  }
  for (PetscInt i = n, least = n; i-- > 0;) {
    least = std::min(least, nearest[std::size_t(i)]);
    if (least < i) is_free[std::size_t(i)] = 0;
  }
  return is_free;
}

}  // namespace

void multiply_narrow(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                     double* Y)
{
  on_widest_lanes(
      [=]<int numbers>() { multiply_panel<numbers, narrow_panel>(A, n_alike, rows, panel, Y); });
}

void multiply_wide(const Csr& A, const char* n_alike, const RowSpan& rows, const double* panel,
                   double* Y)
{
  on_widest_lanes(
      [=]<int numbers>() { multiply_panel<numbers, wide_panel>(A, n_alike, rows, panel, Y); });
}

void add_narrow(const Csr& A, const RowSpan& rows, const double* panel, double* Y)
{
  on_widest_lanes([=]<int numbers>() { add_panel<numbers, narrow_panel>(A, rows, panel, Y); });
}

void add_wide(const Csr& A, const RowSpan& rows, const double* panel, double* Y)
{
  on_widest_lanes([=]<int numbers>() { add_panel<numbers, wide_panel>(A, rows, panel, Y); });
}

std::vector<PetscInt> cuts(const Csr& A, PetscInt n)
{
  constexpr PetscInt most_pieces = 16;  // bits of a mask are enough for them
  std::vector<PetscInt> rows;
  const PetscInt least = std::max<PetscInt>(n / most_pieces, 1);
  const std::vector<char> is_free = free_cuts(A, n);
  for (PetscInt i = least, last = 0; i + least <= n; ++i) {
    if (is_free[std::size_t(i)] == 0 || i - last < least) continue;
    rows.push_back(i);
    last = i;
  }
  return rows;
}

std::vector<char> numbers_alike(const Csr& A, PetscInt n)
{
  std::vector<char> n_alike(std::size_t(n), 1);
  for (PetscInt i = n - 1; i-- > 0;) {
    const char next = n_alike[std::size_t(i) + 1];
    if (std::ranges::equal(A.row(i), A.row(i + 1)))
      n_alike[std::size_t(i)] = static_cast<char>(next % most_alike + 1);
  }
  return n_alike;
}

}  // namespace chladni::linear
