#pragma once

#include <vector>

#include "plate/assembly/block_rows.hpp"

namespace chladni::plate {

/// Some numbers of each node in the columns of a pattern, which ranks have for their rows.
class NodeValues {
 public:
  /// @param own  [n n_rows] n numbers of each node of this rank
  /// @note   Collective on `comm`.
  NodeValues(const BlockPattern& pattern, std::vector<double> own, MPI_Comm comm);

  /// [n] those of a node in the columns of the pattern.
  const double* of(PetscInt node) const;

 private:
  PetscInt n_, first_;
  std::vector<double> own_, other_;
  std::vector<PetscInt> other_nodes_;  ///< ascending
};

}  // namespace chladni::plate
