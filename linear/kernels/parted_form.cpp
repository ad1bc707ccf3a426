#include "linear/kernels/parted_form.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/form_parts.hpp"
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

/// Columns with the rows of a part.
struct Columns {
  petsc::Matrix own;              ///< empty where they are all
  Mat values;                     ///< dense
  std::vector<PetscInt> numbers;  ///< among all
};

Columns taken(Mat X, const FormPart& part, std::size_t number, Mat A_part)
{
  const LocalRows all(X);
  Columns some{.own = uninitialized_dense(A_part, std::ssize(part.columns[number])),
               .values = nullptr,
               .numbers = part.columns[number]};
  some.values = some.own;
  PetscScalar* to = nullptr;
  petsc::check(MatDenseGetArrayWrite(some.values, &to));
  for (const PetscInt j : some.numbers)
    for (const PetscInt i : part.rows) *to++ = all(i, j);
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

/// visit(j, first, A X_j) for some columns from the first on of each X_j.
template <typename Visit>
void for_products(std::span<const Columns> X, Mat A, const Visit& visit)
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

/// Adds what all columns are with each other, in the upper triangle.
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

/// Adds [X_1 X_2 ...]^T A X_1 for a symmetric A: the upper triangle of the first block, all of the
/// others.
void add_leading(MatrixXd& F, const std::vector<Columns>& X, Mat A)
{
  for_products(std::span(X).first(1), A, [&](std::size_t /*j*/, PetscInt first, Mat A_X) {
    const PetscInt n = n_columns_of(A_X);
    const std::span right(X[0].numbers.data() + first, std::size_t(n));
    for (std::size_t i = 0; i < X.size(); ++i) {
      const auto n_left = i == 0 ? first + n : static_cast<PetscInt>(X[i].numbers.size());
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

/// work(columns of each X with the rows of a part, A of the part) for each part of A; the numbers
/// of columns count over all X.
template <typename Work>
void for_parts(std::span<const Mat> X, Mat A, const Work& work)
{
  std::vector<PetscInt> first{0};
  for (const Mat some : X) first.push_back(first.back() + n_columns_of(some));
  const auto numbered = [&](std::vector<Columns> columns) {
    for (std::size_t i = 0; i < X.size(); ++i)
      for (PetscInt& number : columns[i].numbers) number += first[i];
    return columns;
  };
  const std::vector<FormPart> parts = form_parts(A, X);
  if (parts.empty()) {
    std::vector<Columns> all;
    for (const Mat some : X) all.push_back(all_of(some));
    work(numbered(std::move(all)), A);
  }
  for (const FormPart& part : parts) {
    const petsc::Matrix A_part = matrix_of(part, A);
    std::vector<Columns> columns;
    for (std::size_t i = 0; i < X.size(); ++i) columns.push_back(taken(X[i], part, i, A_part));
    work(numbered(std::move(columns)), A_part);
  }
}

PetscInt n_columns_of_all(std::span<const Mat> X)
{
  PetscInt n = 0;
  for (const Mat some : X) n += n_columns_of(some);
  return n;
}

}  // namespace

MatrixXd parted_form(Mat X, Mat A, Mat Y)
{
  const PetscInt n_X = n_columns_of(X);
  MatrixXd F = MatrixXd::Zero(n_X, n_columns_of(Y));
  for_parts(std::array{X, Y}, A, [&](const std::vector<Columns>& columns, Mat part) {
    const Columns &left = columns[0], &right = columns[1];
    std::vector<PetscInt> of_Y = right.numbers;
    for (PetscInt& number : of_Y) number -= n_X;
    F(left.numbers, of_Y) += form(left.values, part, right.values);
  });
  return F;
}

MatrixXd parted_form(std::span<const Mat> X, Mat A, FormSymmetry symmetry)
{
  const PetscInt n = n_columns_of_all(X);
  MatrixXd F = MatrixXd::Zero(n, n);
  for_parts(X, A, [&](const std::vector<Columns>& columns, Mat part) {
    if (symmetry == FormSymmetry::symmetric) return add_symmetric(F, columns, part);
    add_unsymmetric(F, columns, part);
  });
  if (symmetry == FormSymmetry::symmetric) return F.selfadjointView<Eigen::Upper>();
  sum_over_ranks(values_of(F), petsc::communicator(A));
  return F;
}

MatrixXd leading_columns_of_form(std::span<const Mat> X, Mat A)
{
  const PetscInt n_first = n_columns_of(X.front());
  MatrixXd F = MatrixXd::Zero(n_columns_of_all(X), n_first);
  for_parts(X, A,
            [&](const std::vector<Columns>& columns, Mat part) { add_leading(F, columns, part); });
  F.topRows(n_first) = MatrixXd(F.topRows(n_first).selfadjointView<Eigen::Upper>());
  return F;
}

}  // namespace chladni::linear
