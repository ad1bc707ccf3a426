#pragma once

#include <span>
#include <vector>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"

namespace chladni::linear {

/// Rows first .. last - 1 of a matrix, which this rank has.
struct RowRange {
  MPI_Comm comm;
  PetscInt first, last;
};

/// Moves right-hand sides and solutions between the rows of a matrix, distributed as PETSc has
/// them, and the slots of panels, distributed as the factor is.
class SlotExchange {
 public:
  SlotExchange() = default;
  /// @param owner  [n] of each row: the rank that eliminates it, or all_ranks.
  /// @param slot   [n] of each row, on this rank; only those that are here are read.
  /// @note   Collective.
  SlotExchange(const RowRange& here, const std::vector<int>& owner, const std::vector<int>& slot);

  /// Columns from `first` on into panels; slots that all ranks have get it from one of them, the
  /// others zero.
  void to_slots(LocalColumns X, PetscInt first, Panels panels) const;
  /// Panels into those columns, one after the other.
  void to_rows(Panels panels, std::span<const int> columns, LocalColumns X) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<int> rows_;   ///< of this rank in the matrix, by the rank that eliminates them
  std::vector<int> slots_;  ///< of this rank in the panels, by the rank that has their rows
  std::vector<int> row_counts_, slot_counts_, row_starts_, slot_starts_;  ///< rows
  std::vector<int> common_rows_, common_slots_;  ///< rows of this rank that all eliminate
  std::vector<int> other_common_slots_;          ///< of rows of other ranks
};

}  // namespace chladni::linear
