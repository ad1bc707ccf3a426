#pragma once

#include <span>
#include <vector>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/supernodal/subtrees.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"

namespace chladni::linear {

/// Rows first .. last - 1 of a matrix, which this rank has.
struct RowRange {
  MPI_Comm comm;
  PetscInt first, last;
};

/// Who eliminates a row, and where it stands in the panels of this rank, if at all.
struct RowSlot {
  RankGroup group;
  int slot;
};

/// Moves right-hand sides and solutions between the rows of a matrix, distributed as PETSc has
/// them, and the slots of panels, distributed as the factor is. Of several ranks that eliminate a
/// row, one gets it: the one that has it in the matrix, if it is among them, else the first.
class SlotExchange {
 public:
  SlotExchange() = default;
  /// @param rows  [n] all of them, in the order of the matrix
  /// @note   Collective.
  SlotExchange(const RowRange& here, const std::vector<RowSlot>& rows);

  /// Columns from `first` on into panels; zero on the other ranks that eliminate a row.
  void to_slots(LocalColumns X, PetscInt first, Panels panels) const;
  /// Panels into those columns, one after the other.
  void to_rows(Panels panels, std::span<const int> columns, LocalColumns X) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<int> rows_;   ///< of this rank in the matrix, by the rank that gets them
  std::vector<int> slots_;  ///< of this rank in the panels, by the rank that has their rows
  std::vector<int> row_counts_, slot_counts_, row_starts_, slot_starts_;  ///< rows
  std::vector<int> zero_slots_;  ///< here, of rows that another rank gets
};

}  // namespace chladni::linear
