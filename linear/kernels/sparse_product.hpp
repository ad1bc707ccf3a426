#pragma once

#include <optional>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/aligned_numbers.hpp"
#include "linear/kernels/borrowed_rows.hpp"
#include "linear/kernels/ghost_rows.hpp"

namespace chladni::linear {

/// Products of a sparse matrix with blocks of columns, sixteen or eight columns per pass over the
/// matrix. The product is limited by memory traffic; the matrix is read a quarter as often as by
/// PETSc's MatMatMult of AIJ and dense matrices, and the result is not allocated anew.
class SparseProduct {
 public:
  /// @param A  [n x n], kept by reference if it is of type AIJ, otherwise converted; must not
  ///           change during the lifetime of this object
  /// @note   Collective on the communicator of A.
  explicit SparseProduct(Mat A);
  /// Products in some rows alone; the others become zero.
  /// @param rows  of this rank, counted from its first, ascending
  SparseProduct(Mat A, std::vector<PetscInt> rows);
  ~SparseProduct();
  SparseProduct(const SparseProduct&) = delete;
  SparseProduct& operator=(const SparseProduct&) = delete;

  /// Y <- A X for dense X, Y whose rows are distributed as those of A.
  /// @note   Collective.
  void apply(Mat X, Mat Y) const;

 private:
  petsc::Matrix A_;  ///< AIJ
  PetscInt n_rows_ = 0;
  /// Columns of this rank, and of others (by place among the ghosts).
  std::optional<BorrowedRows> own_, other_;
  std::vector<PetscInt> rows_;  ///< that are multiplied
  GhostRows ghosts_;
  AlignedNumbers panel_, product_;
};

/// A X for a dense X with the rows of A.
/// @note   Collective.
petsc::Matrix sparse_product(Mat A, Mat X);

}  // namespace chladni::linear
