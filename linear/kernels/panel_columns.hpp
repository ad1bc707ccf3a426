#pragma once

#include <span>

#include "common/petsc.hpp"

namespace chladni::linear {

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
