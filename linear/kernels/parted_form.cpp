#include "linear/kernels/parted_form.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

constexpr PetscInt block_columns = 64;  // at a time: bounds the memory, enough for dgemm

PetscInt n_columns_of(Mat X)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(X, nullptr, &n));
  return n;
}

/// Some rows of this rank, counted from its first.
std::vector<PetscInt> local_rows(IS rows, Mat A)
{
  PetscInt first = 0, n = 0;
  const PetscInt* global = nullptr;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  petsc::check(ISGetLocalSize(rows, &n));
  petsc::check(ISGetIndices(rows, &global));
  std::vector<PetscInt> local;
  for (PetscInt i = 0; i < n; ++i) local.push_back(global[i] - first);
  petsc::check(ISRestoreIndices(rows, &global));
  return local;
}

/// The columns of X that are not zero in some rows, the same on every rank.
std::vector<PetscInt> columns_in(const LocalRows& X, const std::vector<PetscInt>& rows,
                                 MPI_Comm comm)
{
  std::vector<int> is_there(X.n_cols(), 0);
  for (PetscInt j = 0; j < X.n_cols(); ++j)
    is_there[j] = std::ranges::any_of(rows, [&](PetscInt i) { return X(i, j) != 0.0; }) ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, is_there.data(), static_cast<int>(is_there.size()), MPI_INT, MPI_MAX,
                comm);
  std::vector<PetscInt> columns;
  for (PetscInt j = 0; j < X.n_cols(); ++j)
    if (is_there[j] != 0) columns.push_back(j);
  return columns;
}

/// Columns with the rows of a part.
struct Columns {
  petsc::Matrix own;              ///< empty where they are all
  Mat values;                     ///< dense
  std::vector<PetscInt> numbers;  ///< among all
};

Columns taken(Mat X, const std::vector<PetscInt>& rows, Mat part)
{
  const LocalRows all(X);
  Columns some{
      .own = {}, .values = nullptr, .numbers = columns_in(all, rows, petsc::communicator(X))};
  some.own = uninitialized_dense(part, std::ssize(some.numbers));
  some.values = some.own;
  PetscScalar* to = nullptr;
  petsc::check(MatDenseGetArrayWrite(some.values, &to));
  for (const PetscInt j : some.numbers)
    for (const PetscInt i : rows) *to++ = all(i, j);
  petsc::check(MatDenseRestoreArrayWrite(some.values, &to));
  return some;
}

Columns all_of(Mat X)
{
  Columns all{
      .own = {}, .values = X, .numbers = std::vector<PetscInt>(std::size_t(n_columns_of(X)))};
  std::iota(all.numbers.begin(), all.numbers.end(), 0);
  return all;
}

MatrixXd form(Mat X, Mat A, Mat Y)
{
  const PetscInt n = n_columns_of(Y);
  MatrixXd F(n_columns_of(X), n);
  const SparseProduct product(A);
  for (PetscInt first = 0; first < n; first += block_columns) {
    report_progress(double(first) / n);
    const PetscInt last = std::min(first + block_columns, n);
    const petsc::Matrix A_Y = uninitialized_dense(A, last - first);
    product.apply(ColumnRange(Y, first, last), A_Y);
    F.middleCols(first, last - first) = inner_product(X, A_Y);
  }
  return F;
}

/// visit(j, first, A X) for some columns from the first on of each part X_j of X.
template <typename Visit>
void for_products(const std::vector<Columns>& X, Mat A, const Visit& visit)
{
  const SparseProduct product(A);
  for (std::size_t j = 0; j < X.size(); ++j) {
    const auto n = static_cast<PetscInt>(X[j].numbers.size());
    for (PetscInt first = 0; first < n; first += block_columns) {
      report_progress(double(first) / n);
      const PetscInt last = std::min(first + block_columns, n);
      const petsc::Matrix A_X = uninitialized_dense(A, last - first);
      product.apply(ColumnRange(X[j].values, first, last), A_X);
      visit(j, first, A_X);
    }
  }
}

/// Adds what some columns of all are with each other, in the upper triangle.
void add_symmetric(MatrixXd& F, const std::vector<Columns>& X, Mat A)
{
  for_products(X, A, [&](std::size_t j, PetscInt first, Mat A_X) {
    const PetscInt n = n_columns_of(A_X);
    const std::span right(X[j].numbers.data() + first, std::size_t(n));
    for (std::size_t i = 0; i <= j; ++i) {
      const auto n_left = i == j ? first + n : static_cast<PetscInt>(X[i].numbers.size());
      F(std::span(X[i].numbers.data(), std::size_t(n_left)), right) +=
          inner_product(ColumnRange(X[i].values, 0, n_left), A_X);
    }
  });
}

/// Rows of this rank that have entries, counted from its first.
std::vector<PetscInt> rows_with_entries(Mat A)
{
  PetscInt begin = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, nullptr));
  std::vector<PetscInt> rows;
  for_local_entries(A, [&](PetscInt row, PetscInt /*column*/, double value) {
    if (value != 0.0 && (rows.empty() || rows.back() != row - begin)) rows.push_back(row - begin);
  });
  return rows;
}

/// Rows of this rank, of the columns that are not zero there.
struct OwnColumns {
  MatrixXd values;
  std::vector<PetscInt> numbers;
};

/// @param numbers  of the columns of X
OwnColumns own_columns(Mat X, const std::vector<PetscInt>& rows, std::span<const PetscInt> numbers)
{
  const LocalRows all(X);
  OwnColumns some{.values = MatrixXd(std::ssize(rows), all.n_cols()), .numbers = {}};
  for (PetscInt j = 0; j < all.n_cols(); ++j) {
    auto column = some.values.col(std::ssize(some.numbers));
    for (std::size_t i = 0; i < rows.size(); ++i) column[Eigen::Index(i)] = all(rows[i], j);
    if (!column.isZero(0.0)) some.numbers.push_back(numbers[std::size_t(j)]);
  }
  some.values.conservativeResize(Eigen::NoChange, std::ssize(some.numbers));
  return some;
}

/// The same of any A, this rank's part of the sum. Where A tells of one direction with another,
/// half of its rows have no entry and half of the products with it are zero.
void add_unsymmetric(MatrixXd& F, const std::vector<Columns>& X, Mat A)
{
  const std::vector<PetscInt> rows = rows_with_entries(A);
  std::vector<OwnColumns> left;
  for (const Columns& part : X) left.push_back(own_columns(part.values, rows, part.numbers));
  for_products(X, A, [&](std::size_t j, PetscInt first, Mat A_X) {
    const OwnColumns right =
        own_columns(A_X, rows, {X[j].numbers.data() + first, std::size_t(n_columns_of(A_X))});
    for (const OwnColumns& part : left)
      F(part.numbers, right.numbers) += inner_product(part.values, right.values);
  });
}

/// work(A of the set, its rows) for each set in which A has entries other than zero.
template <typename Work>
void for_parts(const std::vector<petsc::IndexSet>& sets, Mat A, const Work& work)
{
  for (const petsc::IndexSet& rows : sets) {
    petsc::Matrix part;
    PetscReal largest = 0.0;
    petsc::check(MatCreateSubMatrix(A, rows, rows, MAT_INITIAL_MATRIX, part.put()));
    petsc::check(MatNorm(part, NORM_INFINITY, &largest));
    if (largest > 0.0) work(part, local_rows(rows, A));
  }
}

void add(MatrixXd& F, const Columns& X, const Columns& Y, const MatrixXd& part)
{
  for (Eigen::Index j = 0; j < part.cols(); ++j)
    for (Eigen::Index i = 0; i < part.rows(); ++i) F(X.numbers[i], Y.numbers[j]) += part(i, j);
}

}  // namespace

MatrixXd parted_form(Mat X, Mat A, Mat Y)
{
  const std::vector<petsc::IndexSet> sets = decoupled_rows(A, A);
  if (sets.empty()) return form(X, A, Y);
  MatrixXd F = MatrixXd::Zero(n_columns_of(X), n_columns_of(Y));
  for_parts(sets, A, [&](Mat part, const std::vector<PetscInt>& rows) {
    const Columns left = taken(X, rows, part), right = taken(Y, rows, part);
    add(F, left, right, form(left.values, part, right.values));
  });
  return F;
}

MatrixXd parted_form(std::span<const Mat> X, Mat A, FormSymmetry symmetry)
{
  std::vector<PetscInt> first{0};
  for (const Mat part : X) first.push_back(first.back() + n_columns_of(part));
  MatrixXd F = MatrixXd::Zero(first.back(), first.back());
  const auto add_of = [&](Mat part, const auto& columns_of) {
    std::vector<Columns> columns;
    for (std::size_t i = 0; i < X.size(); ++i) {
      columns.push_back(columns_of(X[i]));
      for (PetscInt& number : columns.back().numbers) number += first[i];
    }
    if (symmetry == FormSymmetry::symmetric) return add_symmetric(F, columns, part);
    add_unsymmetric(F, columns, part);
  };
  const std::vector<petsc::IndexSet> sets = decoupled_rows(A, A);
  if (sets.empty()) add_of(A, all_of);
  for_parts(sets, A, [&](Mat part, const std::vector<PetscInt>& rows) {
    add_of(part, [&](Mat all) { return taken(all, rows, part); });
  });
  if (symmetry == FormSymmetry::symmetric) return F.selfadjointView<Eigen::Upper>();
  sum_over_ranks(values_of(F), petsc::communicator(A));
  return F;
}

}  // namespace chladni::linear
