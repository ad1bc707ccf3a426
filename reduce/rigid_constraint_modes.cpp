#include "reduce/rigid_constraint_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "reduce/block_rows.hpp"

namespace chladni::reduce {

namespace {

/// S A^(-1/2) with the eigenvectors S of a semidefinite A in units of its diagonal, as far as A is
/// regular.
linear::SmallMatrix inverse_root(linear::SmallMatrix A, MPI_Comm comm)
{
  constexpr double singular = 1e-12;
  std::vector<double> unit;
  for (PetscInt i = 0; i < A.n_rows; ++i) {
    unit.push_back(A(i, i) > 0.0 ? 1.0 / std::sqrt(A(i, i)) : 0.0);
  }
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) A(i, j) *= unit[i] * unit[j];
  }
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(std::move(A), comm);
  const auto n = static_cast<PetscInt>(eigen.values.size());
  const auto first = static_cast<PetscInt>(std::ranges::upper_bound(eigen.values, singular) -
                                           eigen.values.begin());
  linear::SmallMatrix root(n, n - first);
  for (PetscInt j = first; j < n; ++j) {
    for (PetscInt i = 0; i < n; ++i) {
      root(i, j - first) = unit[i] * eigen.vectors(i, j) / std::sqrt(eigen.values[j]);
    }
  }
  return root;
}

/// X^T X after its rows are scaled by the power p of the diagonal of K_ss.
linear::SmallMatrix scaled_gram(petsc::Matrix X, Mat K_ss, double p)
{
  petsc::Vector d;
  petsc::check(MatCreateVecs(K_ss, nullptr, d.put()));
  petsc::check(MatGetDiagonal(K_ss, d));
  petsc::check(VecPow(d, p));
  petsc::check(MatDiagonalScale(X, d, nullptr));
  return linear::inner_product(X, X);
}

/// Combinations Y of the motions with K_sm R_m + K_ss R_s = 0 to round-off, in units of the
/// diagonal.
linear::SmallMatrix unresisted(const linear::SmallMatrix& R_m, Mat R_s, const Blocks& K)
{
  constexpr double round_off = 64.0 * std::numeric_limits<double>::epsilon();
  const MPI_Comm comm = petsc::communicator(K.ss);
  petsc::Matrix force = linear::uninitialized_dense(K.ss, R_m.n_cols), copy;
  linear::SparseProduct(K.ss).apply(R_s, force);
  linear::add_sparse_product(K.sm, R_m, force);
  petsc::check(MatDuplicate(R_s, MAT_COPY_VALUES, copy.put()));
  const linear::SmallMatrix S = inverse_root(scaled_gram(std::move(copy), K.ss, 0.5), comm);
  const linear::SmallMatrix F = scaled_gram(std::move(force), K.ss, -0.5);
  const linear::SymmetricEigen share =
      linear::symmetric_eigen(linear::product(linear::transposed(S), linear::product(F, S)), comm);
  const auto n =
      std::ranges::upper_bound(share.values, round_off * round_off) - share.values.begin();
  linear::SmallMatrix first(S.n_cols, static_cast<PetscInt>(n));
  std::copy_n(share.vectors.values.begin(), first.values.size(), first.values.begin());
  return linear::product(S, first);
}

/// (R^T W R)^-1 R^T W with the diagonal W of K_mm, on the masters' share of the motions.
linear::SmallMatrix weighted_inverse(const linear::SmallMatrix& R_m,
                                     const linear::SmallMatrix& K_mm, MPI_Comm comm)
{
  linear::SmallMatrix WR = R_m;
  for (PetscInt j = 0; j < WR.n_cols; ++j) {
    for (PetscInt i = 0; i < WR.n_rows; ++i) WR(i, j) *= std::max(K_mm(i, i), 0.0);
  }
  const linear::SmallMatrix root = inverse_root(linear::product(linear::transposed(R_m), WR), comm);
  return linear::product(linear::product(root, linear::transposed(root)), linear::transposed(WR));
}

}  // namespace

petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions)
{
  const linear::SmallMatrix all_m = master_rows(motions.R, motions.dofs);
  const petsc::Matrix all_s = slave_rows(motions.R, motions.dofs, motions.K.ss);
  const linear::SmallMatrix Y = unresisted(all_m, all_s, motions.K);
  if (Y.n_cols == 0) return Psi;
  const linear::SmallMatrix R_m = linear::product(all_m, Y);
  const petsc::Matrix error = linear::uninitialized_dense(Psi, Y.n_cols);  // R_s - Psi R_m
  petsc::check(MatZeroEntries(error));
  linear::add_product(1.0, all_s, Y, error);
  linear::add_product(-1.0, Psi, R_m, error);
  linear::add_product(
      1.0, error,
      weighted_inverse(R_m, linear::replicate(motions.K.mm), petsc::communicator(motions.K.ss)),
      Psi);
  return Psi;
}

}  // namespace chladni::reduce
