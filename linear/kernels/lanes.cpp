#include "linear/kernels/panel_kernels.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace chladni::linear {

namespace {

int numbers_of_processor()
{
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f")) return 8;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 4;
#endif
  return 2;
}

int& most_numbers()
{
  static int most = numbers_of_processor();
  return most;
}

}  // namespace

int numbers_in_lane()
{
  return most_numbers();
}

int limit_lanes(int most)
{
  most_numbers() =
      std::clamp(static_cast<int>(std::bit_floor(unsigned(most))), 2, numbers_of_processor());
  return most_numbers();
}

namespace {

constexpr int line = 8;            // numbers in a cache line
constexpr std::size_t ahead = 64;  // numbers: what to ask the memory for; eight columns are many

/// Numbers of a lane change places with those of another, a power of two before or behind.
template <int distance, int... k>
[[gnu::always_inline]] inline void exchange(Lane<sizeof...(k)>& a, Lane<sizeof...(k)>& b,
                                            std::integer_sequence<int, k...> /*places*/)
{
  constexpr int n = sizeof...(k);
  const auto first = a.values;
  a.values = __builtin_shufflevector(first, b.values, (k & distance ? n + k - distance : k)...);
  b.values = __builtin_shufflevector(first, b.values, (k & distance ? n + k : k + distance)...);
}

/// As many lanes as numbers in each: neighbours change places, then pairs, then fours.
template <int numbers, int distance = 1>
[[gnu::always_inline]] inline void transpose(Lane<numbers>* x)
{
#pragma GCC unroll 8
  for (int i = 0; i < numbers; ++i)
    if ((i & distance) == 0)
      exchange<distance>(x[i], x[i + distance], std::make_integer_sequence<int, numbers>());
  if constexpr (2 * distance < numbers) transpose<numbers, 2 * distance>(x);
}

/// Where row i is in the columns and in the panel.
[[gnu::always_inline]] inline std::size_t row_of(const PanelRows& rows, PetscInt i)
{
  return static_cast<std::size_t>(rows.rows == nullptr ? i : rows.rows[i]);
}

[[gnu::always_inline]] inline std::size_t slot_of(const PanelRows& rows, PetscInt i)
{
  return static_cast<std::size_t>(rows.slots == nullptr ? i : rows.slots[i]);
}

/// Whether eight rows follow one another in the columns.
[[gnu::always_inline]] inline bool are_in_line(const PanelRows& rows, PetscInt i)
{
  if (i + line > rows.n) return false;
  if (rows.rows == nullptr) return true;
  bool are = true;
  for (int k = 1; k < line; ++k) are = are && rows.rows[i + k] == rows.rows[i] + k;
  return are;
}

/// Eight columns, or fewer.
template <int numbers>
[[gnu::always_inline]] inline void line_to_panel(const double* const* columns, PetscInt n_columns,
                                                 const PanelRows& rows, PetscInt width,
                                                 double* panel)
{
  for (PetscInt i = 0; i < rows.n;) {
    if (n_columns == line && are_in_line(rows, i)) {
      const std::size_t row = row_of(rows, i);
      for (int c = 0; c < line; ++c) __builtin_prefetch(columns[c] + row + ahead);
      for (int k = 0; k < line; k += numbers) {
        for (int c = 0; c < line; c += numbers) {
          Lane<numbers> x[numbers];  // NOLINT(modernize-avoid-c-arrays): registers
#pragma GCC unroll 8
          for (int l = 0; l < numbers; ++l) load(columns[c + l] + row + k, x[l]);
          transpose(x);
#pragma GCC unroll 8
          for (int l = 0; l < numbers; ++l)
            store(x[l], panel + slot_of(rows, i + k + l) * width + c);
        }
      }
      i += line;
    } else {
      double* to = panel + slot_of(rows, i) * width;
      for (PetscInt c = 0; c < n_columns; ++c) to[c] = columns[c][row_of(rows, i)];
      for (PetscInt c = n_columns; c < line; ++c) to[c] = 0.0;
      ++i;
    }
  }
}

template <int numbers>
[[gnu::always_inline]] inline void line_to_columns(const double* panel, PetscInt width,
                                                   const PanelRows& rows, double* const* columns,
                                                   PetscInt n_columns)
{
  for (PetscInt i = 0; i < rows.n;) {
    if (n_columns == line && are_in_line(rows, i)) {
      const std::size_t row = row_of(rows, i);
      for (int c = 0; c < line; ++c) __builtin_prefetch(columns[c] + row + ahead, 1);
      for (int k = 0; k < line; k += numbers) {
        for (int c = 0; c < line; c += numbers) {
          Lane<numbers> x[numbers];  // NOLINT(modernize-avoid-c-arrays): registers
#pragma GCC unroll 8
          for (int l = 0; l < numbers; ++l)
            load(panel + slot_of(rows, i + k + l) * width + c, x[l]);
          transpose(x);
#pragma GCC unroll 8
          for (int l = 0; l < numbers; ++l) store(x[l], columns[c + l] + row + k);
        }
      }
      i += line;
    } else {
      const double* from = panel + slot_of(rows, i) * width;
      for (PetscInt c = 0; c < n_columns; ++c) columns[c][row_of(rows, i)] = from[c];
      ++i;
    }
  }
}

}  // namespace

void to_panel(std::span<const double* const> columns, const PanelRows& rows, PetscInt width,
              double* panel)
{
  const auto n = static_cast<PetscInt>(columns.size());
  for (PetscInt first = 0; first < width; first += line) {
    const PetscInt n_here = std::clamp<PetscInt>(n - first, 0, line);
    const double* const* some = columns.data() + std::min(first, n);
    on_widest_lanes(
        [=]<int numbers>() { line_to_panel<numbers>(some, n_here, rows, width, panel + first); });
  }
}

void to_columns(const double* panel, PetscInt width, const PanelRows& rows,
                std::span<double* const> columns)
{
  const auto n = static_cast<PetscInt>(columns.size());
  for (PetscInt first = 0; first < n; first += line) {
    const PetscInt n_here = std::min<PetscInt>(n - first, line);
    double* const* some = columns.data() + first;
    on_widest_lanes(
        [=]<int numbers>() { line_to_columns<numbers>(panel + first, width, rows, some, n_here); });
  }
}

}  // namespace chladni::linear
