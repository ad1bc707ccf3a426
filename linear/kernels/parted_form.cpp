#include "linear/kernels/parted_form.hpp"

#include <algorithm>
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
  petsc::Matrix values;
  std::vector<PetscInt> numbers;  ///< among all
};

Columns taken(Mat X, const std::vector<PetscInt>& rows, Mat part)
{
  const LocalRows all(X);
  Columns some{.values = {}, .numbers = columns_in(all, rows, petsc::communicator(X))};
  some.values = uninitialized_dense(part, std::ssize(some.numbers));
  PetscScalar* to = nullptr;
  petsc::check(MatDenseGetArrayWrite(some.values, &to));
  for (const PetscInt j : some.numbers)
    for (const PetscInt i : rows) *to++ = all(i, j);
  petsc::check(MatDenseRestoreArrayWrite(some.values, &to));
  return some;
}

/// visit(first, last, X^T A Y of these columns of Y), block after block.
/// @param n_left  (last): how many columns of X are wanted
template <typename Left, typename Visit>
void for_blocks(Mat X, Mat A, Mat Y, const Left& n_left, const Visit& visit)
{
  const PetscInt n = n_columns_of(Y);
  const SparseProduct product(A);
  for (PetscInt first = 0; first < n; first += block_columns) {
    report_progress(double(first) / n);
    const PetscInt last = std::min(first + block_columns, n);
    const petsc::Matrix A_Y = uninitialized_dense(A, last - first);
    product.apply(ColumnRange(Y, first, last), A_Y);
    visit(first, last, inner_product(ColumnRange(X, 0, n_left(last)), A_Y));
  }
}

MatrixXd form(Mat X, Mat A, Mat Y)
{
  const PetscInt n_rows = n_columns_of(X);
  MatrixXd F = MatrixXd::Zero(n_rows, n_columns_of(Y));
  for_blocks(
      X, A, Y, [&](PetscInt) { return n_rows; },
      [&](PetscInt first, PetscInt last, const MatrixXd& block) {
        F.middleCols(first, last - first) = block;
      });
  return F;
}

/// The upper triangle is enough.
MatrixXd form(Mat X, Mat A)
{
  MatrixXd F = MatrixXd::Zero(n_columns_of(X), n_columns_of(X));
  for_blocks(
      X, A, X, [](PetscInt last) { return last; },
      [&](PetscInt first, PetscInt last, const MatrixXd& block) {
        F.block(0, first, last, last - first) = block;
      });
  return F.selfadjointView<Eigen::Upper>();
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

MatrixXd parted_form(Mat X, Mat A)
{
  const std::vector<petsc::IndexSet> sets = decoupled_rows(A, A);
  if (sets.empty()) return form(X, A);
  MatrixXd F = MatrixXd::Zero(n_columns_of(X), n_columns_of(X));
  for_parts(sets, A, [&](Mat part, const std::vector<PetscInt>& rows) {
    const Columns some = taken(X, rows, part);
    add(F, some, some, form(some.values, part));
  });
  return F;
}

}  // namespace chladni::linear
