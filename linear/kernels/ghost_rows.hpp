#pragma once

#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// The exchange of rows of a panel between ranks. One that is not made exchanges nothing.
class GhostRows {
 public:
  GhostRows() = default;
  /// @param ghosts      rows of other ranks that this rank needs, ascending
  /// @param first_rows  [ranks + 1] first row of each rank
  /// @note   Collective on `comm`.
  GhostRows(std::span<const PetscInt> ghosts, const PetscInt* first_rows, MPI_Comm comm);

  PetscInt size() const { return n_ghosts_; }
  /// Takes the ghosts from their owners.
  /// @param own     panel of the rows of this rank
  /// @param ghosts  [size] panel
  /// @note   Collective.
  void take(const double* own, PetscInt width, double* ghosts) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  PetscInt n_ghosts_ = 0;
  std::vector<int> send_rows_, send_counts_, receive_counts_;
  mutable std::vector<double> outbox_;
};

}  // namespace chladni::linear
