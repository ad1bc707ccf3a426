#include "linear/kernels/panel_columns.hpp"

#include <algorithm>

#include "common/fitting_instructions.hpp"
#include "linear/kernels/lines.hpp"

namespace chladni::linear {

namespace {

constexpr PetscInt line = line_numbers;
constexpr std::size_t ahead = 64;  // numbers: what to ask the memory for; eight columns are many

struct Lines {
  Line at[line];  // NOLINT(modernize-avoid-c-arrays): its elements are not passed by value
};

/// Eight times eight numbers: pairs, then squares of two, then of four change places.
[[gnu::always_inline]] inline void transpose(Lines& lines)
{
  Line(&x)[line] = lines.at;
  Line y[line];  // NOLINT(modernize-avoid-c-arrays)
  for (int i = 0; i < line; i += 2) {
    y[i] = __builtin_shufflevector(x[i], x[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    y[i + 1] = __builtin_shufflevector(x[i], x[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < line; i += 4) {
    for (int j = i; j < i + 2; ++j) {
      x[j] = __builtin_shufflevector(y[j], y[j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      x[j + 2] = __builtin_shufflevector(y[j], y[j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int i = 0; i < 4; ++i) {
    y[i] = __builtin_shufflevector(x[i], x[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    y[i + 4] = __builtin_shufflevector(x[i], x[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  for (int i = 0; i < line; ++i) x[i] = y[i];
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
CHLADNI_FITTING_INSTRUCTIONS
void line_to_panel(const double* const* columns, PetscInt n_columns, const PanelRows& rows,
                   PetscInt width, double* panel)
{
  for (PetscInt i = 0; i < rows.n;) {
    if (n_columns == line && are_in_line(rows, i)) {
      Lines x;
      for (int c = 0; c < line; ++c) {
        const double* from = columns[c] + row_of(rows, i);
        __builtin_prefetch(from + ahead);
        load(from, x.at[c]);
      }
      transpose(x);
      for (int k = 0; k < line; ++k) store(x.at[k], panel + slot_of(rows, i + k) * width);
      i += line;
    } else {
      double* to = panel + slot_of(rows, i) * width;
      for (PetscInt c = 0; c < n_columns; ++c) to[c] = columns[c][row_of(rows, i)];
      for (PetscInt c = n_columns; c < line; ++c) to[c] = 0.0;
      ++i;
    }
  }
}

CHLADNI_FITTING_INSTRUCTIONS
void line_to_columns(const double* panel, PetscInt width, const PanelRows& rows,
                     double* const* columns, PetscInt n_columns)
{
  for (PetscInt i = 0; i < rows.n;) {
    if (n_columns == line && are_in_line(rows, i)) {
      Lines x;
      for (int k = 0; k < line; ++k) load(panel + slot_of(rows, i + k) * width, x.at[k]);
      transpose(x);
      for (int c = 0; c < line; ++c) {
        double* to = columns[c] + row_of(rows, i);
        __builtin_prefetch(to + ahead, 1);
        store(x.at[c], to);
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
    line_to_panel(columns.data() + std::min(first, n), n_here, rows, width, panel + first);
  }
}

void to_columns(const double* panel, PetscInt width, const PanelRows& rows,
                std::span<double* const> columns)
{
  const auto n = static_cast<PetscInt>(columns.size());
  for (PetscInt first = 0; first < n; first += line) {
    const PetscInt n_here = std::min(n - first, line);
    line_to_columns(panel + first, width, rows, columns.data() + first, n_here);
  }
}

}  // namespace chladni::linear
