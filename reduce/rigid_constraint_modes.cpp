#include "reduce/rigid_constraint_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/index_sets.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/diagonal.hpp"
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
  const petsc::Vector d = linear::diagonal(K_ss);
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

/// Some slaves of this rank, counted from its first, and the masters that K couples to any of them.
struct CoupledRows {
  std::vector<PetscInt> slaves;
  std::vector<PetscInt> masters;  ///< the same on every rank
};

/// Number of the set that each slave of this rank is in.
std::vector<int> set_of_rows(const std::vector<petsc::IndexSet>& sets, Mat K_ss)
{
  PetscInt n = 0;
  petsc::check(MatGetLocalSize(K_ss, &n, nullptr));
  std::vector<int> set_of_row(std::size_t(n), 0);
  for (std::size_t k = 0; k < sets.size(); ++k)
    for (const PetscInt i : petsc::own_rows(sets[k], K_ss)) set_of_row[i] = static_cast<int>(k);
  return set_of_row;
}

/// All slaves in sets that K_ss does not couple: constraint modes are zero in the sets that their
/// master has no share of.
std::vector<CoupledRows> coupled_rows(const Blocks& K)
{
  const std::vector<petsc::IndexSet> sets = linear::decoupled_rows(K.ss, K.ss);
  const std::size_t n_sets = std::max<std::size_t>(sets.size(), 1);
  const std::vector<int> set_of_row = set_of_rows(sets, K.ss);
  PetscInt begin = 0, n_m = 0;
  petsc::check(MatGetOwnershipRange(K.sm, &begin, nullptr));
  petsc::check(MatGetSize(K.sm, nullptr, &n_m));
  std::vector<int> is_coupled(n_sets * n_m, sets.empty() ? 1 : 0);
  linear::for_local_entries(K.sm, [&](PetscInt row, PetscInt column, double value) {
    if (value != 0.0) is_coupled[std::size_t(set_of_row[row - begin]) * n_m + column] = 1;
  });
  MPI_Allreduce(MPI_IN_PLACE, is_coupled.data(), static_cast<int>(is_coupled.size()), MPI_INT,
                MPI_MAX, petsc::communicator(K.sm));
  std::vector<CoupledRows> coupled(n_sets);
  for (std::size_t i = 0; i < set_of_row.size(); ++i)
    coupled[set_of_row[i]].slaves.push_back(static_cast<PetscInt>(i));
  for (std::size_t k = 0; k < n_sets; ++k)
    for (PetscInt j = 0; j < n_m; ++j)
      if (is_coupled[k * n_m + j] != 0) coupled[k].masters.push_back(j);
  return coupled;
}

/// The rows of a dense matrix that are asked for.
MatrixXd rows_of(const linear::LocalRows& X, std::span<const PetscInt> rows)
{
  MatrixXd some(std::ssize(rows), X.n_cols());
  for (PetscInt j = 0; j < X.n_cols(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      some(static_cast<Eigen::Index>(i), j) = X(rows[i], j);
  return some;
}

/// Psi <- Psi + error W in some rows and columns.
void add_correction(const CoupledRows& rows, Mat error, const MatrixXd& W, Mat Psi)
{
  constexpr std::size_t piece = 1024;  // rows at a time: they and the sums stay in the cache
  const linear::LocalRows errors(error);
  PetscInt ld = 0;
  PetscScalar* psi = nullptr;
  petsc::check(MatDenseGetLDA(Psi, &ld));
  petsc::check(MatDenseGetArray(Psi, &psi));
  for (std::size_t first = 0; first < rows.slaves.size(); first += piece) {
    const auto some =
        std::span(rows.slaves).subspan(first).first(std::min(piece, rows.slaves.size() - first));
    const MatrixXd correction = linear::product(rows_of(errors, some), W);
    for (Eigen::Index j = 0; j < W.cols(); ++j) {
      double* column = psi + std::size_t(rows.masters[j]) * ld;
      for (std::size_t i = 0; i < some.size(); ++i)
        column[some[i]] += correction(static_cast<Eigen::Index>(i), j);
    }
  }
  petsc::check(MatDenseRestoreArray(Psi, &psi));
}

}  // namespace

petsc::Matrix with_rigid_motions(petsc::Matrix Psi, const KnownMotions& motions)
{
  const MatrixXd all_m = master_rows(motions.R, motions.dofs);
  const petsc::Matrix all_s = slave_rows(motions.R, motions.dofs, motions.K.ss);
  const MatrixXd Y = unresisted(all_m, all_s, motions.K);
  if (Y.cols() == 0) return Psi;
  const MatrixXd R_m = linear::product(all_m, Y), K_mm = linear::replicate(motions.K.mm);
  const petsc::Matrix error = linear::uninitialized_dense(Psi, Y.cols());  // R_s - Psi R_m
  petsc::check(MatZeroEntries(error));
  linear::add_product(1.0, all_s, Y, error);
  linear::add_product(-1.0, Psi, R_m, error);
  for (const CoupledRows& rows : coupled_rows(motions.K)) {
    const std::vector<PetscInt>& m = rows.masters;
    if (m.empty()) continue;
    const MatrixXd W =
        weighted_inverse(R_m(m, every), K_mm(m, m), petsc::communicator(motions.K.ss));
    add_correction(rows, error, W, Psi);
  }
  return Psi;
}

}  // namespace chladni::reduce
