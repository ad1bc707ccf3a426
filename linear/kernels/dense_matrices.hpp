#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/petsc.hpp"

namespace chladni::linear {

/// The values of a small matrix that is the same on every rank.
inline std::span<double> values_of(Eigen::MatrixXd& A)
{
  return {A.data(), static_cast<std::size_t>(A.size())};
}

/// Replaces values by their sums over all ranks, on every rank. Their number is not limited by MPI.
/// @note   Collective.
void sum_over_ranks(std::span<double> values, MPI_Comm comm);

/// Replaces values by those of rank 0. Their number is not limited by MPI.
/// @note   Collective.
void broadcast_numbers(std::span<double> values, MPI_Comm comm);

/// The value of the first rank. Use it for decisions: ranks on different processors may differ in
/// the last bit.
/// @note   Collective.
double value_of_first_rank(double value, MPI_Comm comm);

/// Read access to the rows of a dense Mat that this rank owns, column-major.
class LocalRows {
 public:
  explicit LocalRows(Mat dense);
  ~LocalRows();
  LocalRows(const LocalRows&) = delete;
  LocalRows& operator=(const LocalRows&) = delete;

  PetscInt n_rows() const { return n_rows_; }
  PetscInt n_cols() const { return n_cols_; }
  PetscInt leading_dimension() const { return lda_; }
  const double* values() const { return values_; }
  double operator()(PetscInt i, PetscInt j) const { return values_[i + std::size_t(j) * lda_]; }

 private:
  Mat dense_;
  PetscInt n_rows_ = 0, n_cols_ = 0, lda_ = 0;
  const PetscScalar* values_ = nullptr;
};

/// Calls visit(global row, global column, value) for each stored entry of the rows of A on this
/// rank.
template <typename Visit>
void for_local_entries(Mat A, const Visit& visit)
{
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt row = first; row < last; ++row) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    petsc::check(MatGetRow(A, row, &n, &columns, &values));
    for (PetscInt k = 0; k < n; ++k) visit(row, columns[k], values[k]);
    petsc::check(MatRestoreRow(A, row, &n, &columns, &values));
  }
}

/// A dense matrix with the rows of A and values that are not set. PETSc would set them to zero,
/// which touches the memory once more.
/// @note   Collective.
petsc::Matrix uninitialized_dense(Mat A, Eigen::Index n_columns);

/// How many columns with the rows of A to work on at a time: fewer where they are so long that a
/// block of them is a large part of the memory.
/// @param most  of columns that are not long; a multiple of 32
/// @return the same on all ranks; a multiple of 8, no less than a fourth of `most`
PetscInt columns_at_a_time(Mat A, PetscInt most = 32);

/// The columns first .. last - 1 of a dense matrix without a copy, during the lifetime of this
/// object; only one range of a matrix at a time.
class ColumnRange {
 public:
  ColumnRange(Mat dense, PetscInt first, PetscInt last) : dense_(dense)
  {
    petsc::check(MatDenseGetSubMatrix(dense, PETSC_DECIDE, PETSC_DECIDE, first, last, &columns_));
  }
  ~ColumnRange() { MatDenseRestoreSubMatrix(dense_, &columns_); }
  ColumnRange(const ColumnRange&) = delete;
  ColumnRange& operator=(const ColumnRange&) = delete;
  operator Mat() const { return columns_; }  // NOLINT(google-explicit-constructor): as PETSc's

 private:
  Mat dense_;
  Mat columns_ = nullptr;
};

/// X^T Y of two dense matrices with equally distributed rows, on every rank.
/// @note   Collective.
Eigen::MatrixXd inner_product(Mat X, Mat Y);

/// X^T X of a dense matrix, on every rank.
/// @note   Collective.
Eigen::MatrixXd gram(Mat X);

/// X^T Y by the BLAS, which uses kernels for the processor at hand; Eigen's depend on compiler
/// options.
Eigen::MatrixXd inner_product(const Eigen::Ref<const Eigen::MatrixXd>& X,
                              const Eigen::Ref<const Eigen::MatrixXd>& Y);

/// x_k^T y_k of the columns of two dense matrices with equally distributed rows, on every rank.
/// @note   Collective.
std::vector<double> column_products(Mat X, Mat Y);

/// Y <- Y + alpha X S for dense distributed X, Y and a small S.
void add_product(double alpha, Mat X, const Eigen::MatrixXd& S, Mat Y);

/// Y <- Y + A S for a sparse A [n x few columns] and a small S.
void add_sparse_product(Mat A, const Eigen::MatrixXd& S, Mat Y);

/// X^T A for a dense X and a sparse A [n x few columns] with equally distributed rows, on every
/// rank.
/// @note   Collective.
Eigen::MatrixXd inner_product_sparse(Mat X, Mat A);

/// A small distributed sparse matrix as a dense one on every rank.
/// @note   Collective.
Eigen::MatrixXd replicate(Mat A);

}  // namespace chladni::linear
