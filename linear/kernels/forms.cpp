#include "linear/kernels/forms.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "common/petsc.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

PetscInt n_columns_of(Mat X)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(X, nullptr, &n));
  return n;
}

/// Some columns of a dense matrix in the rows of a part. They are copied a few columns, or a few
/// rows, at a time: all of them would be as large as the constraint modes.
class PartColumns {
 public:
  /// @param rows     of this rank, or null: all of them, and all columns
  /// @param columns  of X
  /// @param before   columns of other matrices that count before these
  PartColumns(Mat X, const std::vector<PetscInt>* rows, std::vector<PetscInt> columns,
              PetscInt before)
      : X_(X), rows_(rows), columns_(std::move(columns)), numbers_(columns_)
  {
    for (PetscInt& number : numbers_) number += before;
  }
  /// Copies the rows of a part of few rows for all that `inner` will be asked for.
  void keep_few_rows()
  {
    constexpr std::size_t few = 4;  // a fourth of all
    if (rows_ != nullptr && few * rows_->size() <= std::size_t(LocalRows(X_).n_rows()))
      kept_ = values(*rows_, size());
  }

  PetscInt size() const { return static_cast<PetscInt>(columns_.size()); }
  /// Numbers of the columns first to last among those of all matrices.
  std::span<const PetscInt> numbers(PetscInt first, PetscInt last) const
  {
    return std::span(numbers_).subspan(first, last - first);
  }
  std::span<const PetscInt> numbers() const { return numbers_; }

  /// A times columns first to last.
  petsc::Matrix times(const SparseProduct& A, PetscInt first, PetscInt last, Mat like) const
  {
    petsc::Matrix A_X = uninitialized_dense(like, last - first);
    if (rows_ == nullptr)
      A.apply(ColumnRange(X_, first, last), A_X);
    else
      A.apply(copied(first, last, like), A_X);
    return A_X;
  }

  /// The first n columns transposed times Y, on every rank.
  MatrixXd inner(PetscInt n, Mat Y) const
  {
    if (rows_ == nullptr) return inner_product(ColumnRange(X_, 0, n), Y);
    constexpr std::size_t piece = 1024;  // rows: these columns in a second-level cache
    MatrixXd sum = MatrixXd::Zero(n, n_columns_of(Y));
    if (kept_) {
      const LocalRows right(Y);
      sum = inner_product(kept_->leftCols(n), values_of_rows(right));
    } else {
      const LocalRows right(Y);
      for (std::size_t at = 0; at < rows_->size(); at += piece) {
        const std::size_t n_rows = std::min(piece, rows_->size() - at);
        sum +=
            inner_product(values(std::span(*rows_).subspan(at, n_rows), n),
                          values_of_rows(right).middleRows(Eigen::Index(at), Eigen::Index(n_rows)));
      }
    }
    sum_over_ranks(values_of(sum), petsc::communicator(X_));
    return sum;
  }

  /// Rows of the part, by their places in it, of all columns.
  MatrixXd at(const std::vector<PetscInt>& places) const
  {
    if (rows_ == nullptr) return values(places, size());
    std::vector<PetscInt> rows;
    for (const PetscInt place : places) rows.push_back((*rows_)[place]);
    return values(rows, size());
  }

 private:
  using Values = Eigen::Map<const MatrixXd, 0, Eigen::OuterStride<>>;
  static Values values_of_rows(const LocalRows& Y)
  {
    return {Y.values(), Y.n_rows(), Y.n_cols(), Eigen::OuterStride<>(Y.leading_dimension())};
  }

  MatrixXd values(std::span<const PetscInt> rows, PetscInt n) const
  {
    const LocalRows all(X_);
    MatrixXd some(std::ssize(rows), n);
    for (PetscInt j = 0; j < n; ++j)
      for (std::size_t i = 0; i < rows.size(); ++i)
        some(Eigen::Index(i), j) = all(rows[i], columns_[j]);
    return some;
  }

  petsc::Matrix copied(PetscInt first, PetscInt last, Mat like) const
  {
    const LocalRows all(X_);
    petsc::Matrix some = uninitialized_dense(like, last - first);
    PetscScalar* to = nullptr;
    petsc::check(MatDenseGetArrayWrite(some, &to));
    for (PetscInt j = first; j < last; ++j)
      for (const PetscInt i : *rows_) *to++ = all(i, columns_[j]);
    petsc::check(MatDenseRestoreArrayWrite(some, &to));
    return some;
  }

  Mat X_;
  const std::vector<PetscInt>* rows_;
  std::vector<PetscInt> columns_, numbers_;
  std::optional<MatrixXd> kept_;
};

/// visit(j, first, last, A X_j) for columns first to last of each X_j.
template <typename Visit>
void for_products(std::span<const PartColumns> X, Mat A, const Visit& visit)
{
  constexpr PetscInt enough_for_dgemm = 64;
  const PetscInt block_columns = columns_at_a_time(A, enough_for_dgemm);
  const SparseProduct product(A);
  for (std::size_t j = 0; j < X.size(); ++j) {
    for (PetscInt first = 0; first < X[j].size(); first += block_columns) {
      report_progress(double(first) / X[j].size());
      const PetscInt last = std::min(first + block_columns, X[j].size());
      visit(j, first, last, X[j].times(product, first, last, A));
    }
  }
}

/// Adds what all columns are with each other, in the upper triangle.
void add_symmetric(MatrixXd& F, std::span<PartColumns> X, Mat A)
{
  for (PartColumns& columns : X) columns.keep_few_rows();
  for_products(X, A, [&](std::size_t j, PetscInt first, PetscInt last, Mat A_X) {
    for (std::size_t i = 0; i <= j; ++i) {
      const PetscInt n = i == j ? last : X[i].size();
      F(X[i].numbers(0, n), X[j].numbers(first, last)) += X[i].inner(n, A_X);
    }
  });
}

/// Adds [X_1 X_2 ...]^T A X_1 for a symmetric A: the upper triangle of the first block, all of the
/// others.
void add_leading(MatrixXd& F, std::span<const PartColumns> X, Mat A)
{
  for_products(X.first(1), A, [&](std::size_t /*j*/, PetscInt first, PetscInt last, Mat A_X) {
    for (std::size_t i = 0; i < X.size(); ++i) {
      const PetscInt n = i == 0 ? last : X[i].size();
      F(X[i].numbers(0, n), X[0].numbers(first, last)) += X[i].inner(n, A_X);
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

OwnColumns without_zeros(MatrixXd values, std::span<const PetscInt> numbers)
{
  OwnColumns some{.values = std::move(values), .numbers = {}};
  for (Eigen::Index j = 0; j < some.values.cols(); ++j) {
    if (some.values.col(j).isZero(0.0)) continue;
    some.values.col(std::ssize(some.numbers)) = some.values.col(j);
    some.numbers.push_back(numbers[std::size_t(j)]);
  }
  some.values.conservativeResize(Eigen::NoChange, std::ssize(some.numbers));
  return some;
}

MatrixXd rows_of(Mat X, const std::vector<PetscInt>& rows)
{
  const LocalRows all(X);
  MatrixXd some(std::ssize(rows), all.n_cols());
  for (PetscInt j = 0; j < all.n_cols(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i) some(Eigen::Index(i), j) = all(rows[i], j);
  return some;
}

/// The same of any A, this rank's part of the sum. Where A tells of one direction with another,
/// half of its rows have no entry and half of the products with it are zero.
void add_unsymmetric(MatrixXd& F, std::span<const PartColumns> X, Mat A)
{
  const std::vector<PetscInt> rows = rows_with_entries(A);
  std::vector<OwnColumns> left;
  for (const PartColumns& part : X) left.push_back(without_zeros(part.at(rows), part.numbers()));
  for_products(X, A, [&](std::size_t j, PetscInt first, PetscInt last, Mat A_X) {
    const OwnColumns right = without_zeros(rows_of(A_X, rows), X[j].numbers(first, last));
    for (const OwnColumns& part : left)
      F(part.numbers, right.numbers) += inner_product(part.values, right.values);
  });
}

/// work(columns of each X with the rows of a part, A of the part) for each part of A.
template <typename Work>
void for_parts(std::span<const Mat> X, Mat A, const Work& work)
{
  const std::vector<FormPart> parts = form_parts(A, X);
  const auto columns_of = [&](const FormPart* part) {
    std::vector<PartColumns> columns;
    PetscInt before = 0;
    for (std::size_t i = 0; i < X.size(); ++i) {
      std::vector<PetscInt> all(std::size_t(n_columns_of(X[i])));
      std::iota(all.begin(), all.end(), 0);
      if (part == nullptr)
        columns.emplace_back(X[i], nullptr, std::move(all), before);
      else
        columns.emplace_back(X[i], &part->rows, part->columns[i], before);
      before += n_columns_of(X[i]);
    }
    return columns;
  };
  if (parts.empty()) work(columns_of(nullptr), A);
  for (const FormPart& part : parts) work(columns_of(&part), matrix_of(part, A));
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
  const PetscInt n_X = n_columns_of(X), n_Y = n_columns_of(Y);
  MatrixXd F = MatrixXd::Zero(n_X, n_X + n_Y);  // behind X^T A X, which is not asked for
  for_parts(std::array{X, Y}, A, [&](const std::vector<PartColumns>& columns, Mat part) {
    const PartColumns &left = columns[0], &right = columns[1];
    for_products(std::span(&right, 1), part,
                 [&](std::size_t /*j*/, PetscInt first, PetscInt last, Mat A_Y) {
                   F(left.numbers(), right.numbers(first, last)) += left.inner(left.size(), A_Y);
                 });
  });
  return F.rightCols(n_Y);
}

MatrixXd parted_form(std::span<const Mat> X, Mat A, FormSymmetry symmetry)
{
  const PetscInt n = n_columns_of_all(X);
  MatrixXd F = MatrixXd::Zero(n, n);
  for_parts(X, A, [&](std::vector<PartColumns> columns, Mat part) {
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
  for_parts(X, A, [&](const std::vector<PartColumns>& columns, Mat part) {
    add_leading(F, columns, part);
  });
  F.topRows(n_first) = MatrixXd(F.topRows(n_first).selfadjointView<Eigen::Upper>());
  return F;
}

namespace {

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

/// Sets of rows of this rank in which A has entries other than zero.
std::vector<std::vector<PetscInt>> sets_with_entries(const std::vector<petsc::IndexSet>& sets,
                                                     Mat A)
{
  PetscInt begin = 0, end = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, &end));
  std::vector<char> has_entries(std::size_t(end - begin), 0);
  for_local_entries(A, [&](PetscInt row, PetscInt /*column*/, double value) {
    if (value != 0.0) has_entries[row - begin] = 1;
  });
  std::vector<std::vector<PetscInt>> rows(sets.size());
  std::vector<int> is_there(sets.size(), 0);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    rows[k] = petsc::own_rows(sets[k], A);
    if (std::ranges::any_of(rows[k], [&](PetscInt i) { return has_entries[i] != 0; }))
      is_there[k] = 1;
  }
  MPI_Allreduce(MPI_IN_PLACE, is_there.data(), static_cast<int>(is_there.size()), MPI_INT, MPI_MAX,
                petsc::communicator(A));
  std::vector<std::vector<PetscInt>> some;
  for (std::size_t k = 0; k < sets.size(); ++k)
    if (is_there[k] != 0) some.push_back(std::move(rows[k]));
  return some;
}

}  // namespace

std::vector<FormPart> form_parts(Mat A, std::span<const Mat> X)
{
  std::vector<FormPart> parts;
  for (std::vector<PetscInt>& rows : sets_with_entries(decoupled_rows(A, A), A)) {
    FormPart part{.rows = std::move(rows), .columns = {}};
    for (const Mat all : X)
      part.columns.push_back(columns_in(LocalRows(all), part.rows, petsc::communicator(A)));
    const auto alike = std::ranges::find(parts, part.columns, &FormPart::columns);
    if (alike == parts.end())
      parts.push_back(std::move(part));
    else
      alike->rows.insert(alike->rows.end(), part.rows.begin(), part.rows.end());
  }
  for (FormPart& part : parts) std::ranges::sort(part.rows);
  return parts;
}

petsc::Matrix matrix_of(const FormPart& part, Mat A)
{
  PetscInt begin = 0;
  petsc::check(MatGetOwnershipRange(A, &begin, nullptr));
  std::vector<PetscInt> global = part.rows;
  for (PetscInt& row : global) row += begin;
  petsc::IndexSet rows;
  petsc::check(ISCreateGeneral(petsc::communicator(A), static_cast<PetscInt>(global.size()),
                               global.data(), PETSC_USE_POINTER, rows.put()));
  return own_submatrix(A, rows, rows);
}

}  // namespace chladni::linear
