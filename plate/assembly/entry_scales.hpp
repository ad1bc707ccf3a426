#pragma once

#include <vector>

#include "plate/assembly/block_rows.hpp"

namespace chladni::plate {

/// The size that an entry A_ij of a symmetric matrix is measured by, sqrt |A_ii A_jj|: no entry of
/// a positive semidefinite matrix is larger, and a Cholesky factorisation has errors of a few eps
/// of it. Source: Higham, Accuracy and Stability of Numerical Algorithms (2002), theorem 10.3.
class EntryScales {
 public:
  /// @param own  [n n_rows] sqrt |A_ii| of the rows of this rank
  /// @note   Collective on `comm`.
  EntryScales(const BlockPattern& pattern, std::vector<double> own, MPI_Comm comm);

  /// [n] sqrt |A_jj| of the DOFs of a node in the columns of the pattern.
  const double* of(PetscInt node) const;

 private:
  PetscInt n_, first_;
  std::vector<double> own_, other_;
  std::vector<PetscInt> other_nodes_;  ///< ascending
};

}  // namespace chladni::plate
