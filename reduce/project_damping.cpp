#include <algorithm>

#include "reduce/craig_bampton.hpp"

namespace chladni::reduce {

namespace {

void add_block(SmallMatrix& A, PetscInt first_row, PetscInt first_column, const SmallMatrix& block)
{
  for (PetscInt j = 0; j < block.n_cols; ++j) {
    for (PetscInt i = 0; i < block.n_rows; ++i) A(first_row + i, first_column + j) += block(i, j);
  }
}

SmallMatrix transposed(const SmallMatrix& A)
{
  SmallMatrix A_T(A.n_cols, A.n_rows);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) A_T(j, i) = A(i, j);
  }
  return A_T;
}

/// A dense basis of the slaves and its first coordinate.
struct Columns {
  Mat X;
  PetscInt first;
};

}  // namespace

/// With Q_CB = [I 0; X], X = [Psi Phi]: C_r = C_mm + C_ms X + X^T C_sm + X^T C_ss X.
SmallMatrix project_damping(const CraigBamptonBasis& Q_CB, const Blocks& C)
{
  SmallMatrix C_r = replicate(C.mm);
  const PetscInt n_m = C_r.n_rows;
  std::vector<Columns> parts{{Q_CB.Psi, 0}};
  if (Q_CB.modes) parts.push_back({Q_CB.modes->Phi, n_m});
  SmallMatrix all(n_m + Q_CB.n_modes(), n_m + Q_CB.n_modes());
  add_block(all, 0, 0, C_r);
  petsc::Matrix C_sm_T;  // C_ms^T, that its product with X is one with sparse columns
  petsc::check(MatTranspose(C.ms, MAT_INITIAL_MATRIX, C_sm_T.put()));
  for (const Columns& right : parts) {
    add_block(all, right.first, 0, inner_product_sparse(right.X, C.sm));
    add_block(all, 0, right.first, transposed(inner_product_sparse(right.X, C_sm_T)));
    petsc::Matrix C_ss_X;
    petsc::check(MatMatMult(C.ss, right.X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, C_ss_X.put()));
    for (const Columns& left : parts) {
      add_block(all, left.first, right.first, inner_product(left.X, C_ss_X));
    }
  }
  return all;
}

}  // namespace chladni::reduce
