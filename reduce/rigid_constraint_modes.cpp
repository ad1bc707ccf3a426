#include "reduce/rigid_constraint_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reduce/block_rows.hpp"
#include "reduce/small_matrices.hpp"
#include "reduce/sparse_product.hpp"
#include "reduce/symmetric_eigen.hpp"

namespace chladni::reduce {

namespace {

/// S A^(-1/2) with the eigenvectors S of a semidefinite A in units of its diagonal, as far as A is
/// regular.
SmallMatrix inverse_root(SmallMatrix A, MPI_Comm comm)
{
  constexpr double singular = 1e-12;
  std::vector<double> unit;
  for (PetscInt i = 0; i < A.n_rows; ++i) {
    unit.push_back(A(i, i) > 0.0 ? 1.0 / std::sqrt(A(i, i)) : 0.0);
  }
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) A(i, j) *= unit[i] * unit[j];
  }
  const SymmetricEigen eigen = symmetric_eigen(std::move(A), comm);
  const auto n = static_cast<PetscInt>(eigen.values.size());
  const auto first = static_cast<PetscInt>(std::ranges::upper_bound(eigen.values, singular) -
                                           eigen.values.begin());
  SmallMatrix root(n, n - first);
  for (PetscInt j = first; j < n; ++j) {
    for (PetscInt i = 0; i < n; ++i) {
      root(i, j - first) = unit[i] * eigen.vectors(i, j) / std::sqrt(eigen.values[j]);
    }
  }
  return root;
}

/// X^T X after its rows are scaled by the power p of the diagonal of K_ss.
SmallMatrix scaled_gram(petsc::Matrix X, Mat K_ss, double p)
{
  petsc::Vector d;
  petsc::check(MatCreateVecs(K_ss, nullptr, d.put()));
  petsc::check(MatGetDiagonal(K_ss, d));
  petsc::check(VecPow(d, p));
  petsc::check(MatDiagonalScale(X, d, nullptr));
  return inner_product(X, X);
}

/// Combinations Y of the motions with K_sm R_m + K_ss R_s = 0 to round-off, in units of the
/// diagonal.
SmallMatrix unresisted(const SmallMatrix& R_m, Mat R_s, const Blocks& K)
{
  constexpr double round_off = 64.0 * std::numeric_limits<double>::epsilon();
  const MPI_Comm comm = petsc::communicator(K.ss);
  petsc::Matrix force = uninitialized_dense(K.ss, R_m.n_cols), copy;
  SparseProduct(K.ss).apply(R_s, force);
  add_sparse_product(K.sm, R_m, force);
  petsc::check(MatDuplicate(R_s, MAT_COPY_VALUES, copy.put()));
  const SmallMatrix S = inverse_root(scaled_gram(std::move(copy), K.ss, 0.5), comm);
  const SmallMatrix F = scaled_gram(std::move(force), K.ss, -0.5);
  const SymmetricEigen share = symmetric_eigen(product(transposed(S), product(F, S)), comm);
  const auto n =
      std::ranges::upper_bound(share.values, round_off * round_off) - share.values.begin();
  SmallMatrix first(S.n_cols, static_cast<PetscInt>(n));
  std::copy_n(share.vectors.values.begin(), first.values.size(), first.values.begin());
  return product(S, first);
}

/// (R^T W R)^-1 R^T W with the diagonal W of K_mm, on the masters' share of the motions.
SmallMatrix weighted_inverse(const SmallMatrix& R_m, const SmallMatrix& K_mm, MPI_Comm comm)
{
  SmallMatrix WR = R_m;
  for (PetscInt j = 0; j < WR.n_cols; ++j) {
    for (PetscInt i = 0; i < WR.n_rows; ++i) WR(i, j) *= std::max(K_mm(i, i), 0.0);
  }
  const SmallMatrix root = inverse_root(product(transposed(R_m), WR), comm);
  return product(product(root, transposed(root)), transposed(WR));
}

}  // namespace

petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions)
{
  const SmallMatrix all_m = master_rows(motions.R, motions.dofs);
  const petsc::Matrix all_s = slave_rows(motions.R, motions.dofs, motions.K.ss);
  const SmallMatrix Y = unresisted(all_m, all_s, motions.K);
  if (Y.n_cols == 0) return Psi;
  const SmallMatrix R_m = product(all_m, Y);
  const petsc::Matrix error = uninitialized_dense(Psi, Y.n_cols);  // R_s - Psi R_m
  petsc::check(MatZeroEntries(error));
  add_product(1.0, all_s, Y, error);
  add_product(-1.0, Psi, R_m, error);
  add_product(1.0, error,
              weighted_inverse(R_m, replicate(motions.K.mm), petsc::communicator(motions.K.ss)),
              Psi);
  return Psi;
}

}  // namespace chladni::reduce
