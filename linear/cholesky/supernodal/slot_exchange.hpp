#pragma once

#include <functional>
#include <span>
#include <vector>

#include "linear/cholesky/cholesky_factor.hpp"
#include "linear/cholesky/supernodal/rank_groups.hpp"
#include "linear/cholesky/supernodal/tiled_columns.hpp"

namespace chladni::linear {

/// Where some rows of a matrix are eliminated.
struct RowSlots {
  std::function<RankGroup(int row)> group;  ///< the ranks that eliminate a row
  std::function<int(int row)> slot;         ///< of a row in the panels of this rank
  std::vector<int> here;                    ///< all of these slots on this rank
};

/// Moves right-hand sides and solutions between the rows of a matrix, distributed as in PETSc, and
/// the slots of panels, distributed as the factor. If several ranks eliminate a row, one of them
/// gets it: its owner in the matrix if it is among them, else the first.
class SlotExchange {
 public:
  SlotExchange() = default;
  /// @param rows  those of the matrix that this rank owns, in the order of X
  /// @note   Collective.
  SlotExchange(MPI_Comm comm, const std::vector<int>& rows, const RowSlots& slots);

  /// Copies columns of X, from `first` on, into panels. The slots of a row are zero on the other
  /// ranks that eliminate it.
  void to_slots(LocalColumns X, PetscInt first, Panels panels) const;
  /// Copies panels, one column after the other, into the given columns of X.
  void to_rows(Panels panels, std::span<const int> columns, LocalColumns X) const
  {
    to_rows(panels, columns, X, {});
  }
  /// The same where some rows of this rank are zero: memory that was never touched stays so.
  /// @param is_zero  [own rows]; empty: none
  void to_rows(Panels panels, std::span<const int> columns, LocalColumns X,
               std::span<const char> is_zero) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<int> rows_;   ///< own rows of the matrix, by the rank that gets them
  std::vector<int> slots_;  ///< own slots, by the rank that owns their rows
  std::vector<int> row_counts_, slot_counts_, row_starts_, slot_starts_;  ///< rows
  std::vector<int> zero_slots_;  ///< slots here of rows that another rank gets
};

}  // namespace chladni::linear
