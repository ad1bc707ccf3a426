#pragma once

#include <vector>

#include "plate/assembly/block_rows.hpp"

namespace chladni::plate {

/// The scale sqrt |A_ii A_jj| of an entry A_ij of a symmetric matrix. No entry of a positive
/// semidefinite matrix is larger, and the errors of a Cholesky factorisation are a few eps of it.
/// Source: Higham, Accuracy and Stability of Numerical Algorithms (2002), theorem 10.3.
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
