#pragma once

#include "common/petsc.hpp"
#include "linear/kernels/panel_product.hpp"

namespace chladni::linear {

/// Read access to the arrays of a sequential AIJ matrix, during the lifetime of this object.
class BorrowedRows {
 public:
  explicit BorrowedRows(Mat sequential) : matrix_(sequential)
  {
    PetscBool done = PETSC_FALSE;
    petsc::check(MatGetRowIJ(matrix_, 0, PETSC_FALSE, PETSC_FALSE, &n_rows_, &arrays_.starts,
                             &arrays_.columns, &done));
    if (done == PETSC_FALSE)
      throw Error("a sparse product needs a matrix of type AIJ; convert it by MatConvert");
    petsc::check(MatSeqAIJGetArrayRead(matrix_, &arrays_.values));
  }
  ~BorrowedRows()
  {
    PetscBool done = PETSC_FALSE;
    MatSeqAIJRestoreArrayRead(matrix_, &arrays_.values);
    MatRestoreRowIJ(matrix_, 0, PETSC_FALSE, PETSC_FALSE, &n_rows_, &arrays_.starts,
                    &arrays_.columns, &done);
  }
  BorrowedRows(const BorrowedRows&) = delete;
  BorrowedRows& operator=(const BorrowedRows&) = delete;

  const CsrArrays& arrays() const { return arrays_; }

 private:
  Mat matrix_;
  PetscInt n_rows_ = 0;
  CsrArrays arrays_{};
};

/// The two sequential matrices of the rows of this rank: columns of its own, and of other ranks.
struct OwnAndOther {
  Mat own, other;          ///< other: null on one rank
  const PetscInt* ghosts;  ///< global columns of `other`, ascending
  PetscInt n_ghosts;
};

/// @param A  AIJ
inline OwnAndOther own_and_other(Mat A)
{
  OwnAndOther parts{.own = A, .other = nullptr, .ghosts = nullptr, .n_ghosts = 0};
  PetscBool is_distributed = PETSC_FALSE;
  petsc::check(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(A), MATMPIAIJ, &is_distributed));
  if (is_distributed == PETSC_FALSE) return parts;
  petsc::check(MatMPIAIJGetSeqAIJ(A, &parts.own, &parts.other, &parts.ghosts));
  petsc::check(MatGetSize(parts.other, nullptr, &parts.n_ghosts));
  return parts;
}

}  // namespace chladni::linear
