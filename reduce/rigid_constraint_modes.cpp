#include "reduce/rigid_constraint_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/kernels/symmetric_eigen.hpp"
#include "reduce/block_rows.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// S A^(-1/2) with the eigenvectors S of a semidefinite A in units of its diagonal, as far as A is
/// regular.
MatrixXd inverse_root(MatrixXd A, MPI_Comm comm)
{
  constexpr double singular = 1e-12;
  std::vector<double> unit;
  for (PetscInt i = 0; i < A.rows(); ++i)
    unit.push_back(A(i, i) > 0.0 ? 1.0 / std::sqrt(A(i, i)) : 0.0);
  for (PetscInt j = 0; j < A.cols(); ++j)
    for (PetscInt i = 0; i < A.rows(); ++i) A(i, j) *= unit[i] * unit[j];
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(std::move(A), comm);
  const auto n = static_cast<PetscInt>(eigen.values.size());
  const auto first = static_cast<PetscInt>(std::ranges::upper_bound(eigen.values, singular) -
                                           eigen.values.begin());
  MatrixXd root = MatrixXd::Zero(n, n - first);
  for (PetscInt j = first; j < n; ++j)
    for (PetscInt i = 0; i < n; ++i)
      root(i, j - first) = unit[i] * eigen.vectors(i, j) / std::sqrt(eigen.values[j]);
  return root;
}

/// X^T X after its rows are scaled by the power p of the diagonal of K_ss.
MatrixXd scaled_gram(petsc::Matrix X, Mat K_ss, double p)
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
MatrixXd unresisted(const MatrixXd& R_m, Mat R_s, const Blocks& K)
{
  constexpr double round_off = 64.0 * std::numeric_limits<double>::epsilon();
  const MPI_Comm comm = petsc::communicator(K.ss);
  petsc::Matrix force = linear::uninitialized_dense(K.ss, R_m.cols()), copy;
  linear::SparseProduct(K.ss).apply(R_s, force);
  linear::add_sparse_product(K.sm, R_m, force);
  petsc::check(MatDuplicate(R_s, MAT_COPY_VALUES, copy.put()));
  const MatrixXd S = inverse_root(scaled_gram(std::move(copy), K.ss, 0.5), comm);
  const MatrixXd F = scaled_gram(std::move(force), K.ss, -0.5);
  const linear::SymmetricEigen share =
      linear::symmetric_eigen(linear::product(S.transpose(), linear::product(F, S)), comm);
  const auto n =
      std::ranges::upper_bound(share.values, round_off * round_off) - share.values.begin();
  return linear::product(S, share.vectors.leftCols(n));
}

/// (R^T W R)^-1 R^T W with the diagonal W of K_mm, on the masters' share of the motions.
MatrixXd weighted_inverse(const MatrixXd& R_m, const MatrixXd& K_mm, MPI_Comm comm)
{
  MatrixXd WR = R_m;
  for (PetscInt j = 0; j < WR.cols(); ++j)
    for (PetscInt i = 0; i < WR.rows(); ++i) WR(i, j) *= std::max(K_mm(i, i), 0.0);
  const MatrixXd root = inverse_root(linear::product(R_m.transpose(), WR), comm);
  return linear::product(linear::product(root, root.transpose()), WR.transpose());
}

}  // namespace

petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions)
{
  const MatrixXd all_m = master_rows(motions.R, motions.dofs);
  const petsc::Matrix all_s = slave_rows(motions.R, motions.dofs, motions.K.ss);
  const MatrixXd Y = unresisted(all_m, all_s, motions.K);
  if (Y.cols() == 0) return Psi;
  const MatrixXd R_m = linear::product(all_m, Y);
  const petsc::Matrix error = linear::uninitialized_dense(Psi, Y.cols());  // R_s - Psi R_m
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
