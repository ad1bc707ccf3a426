#include "linear/kernels/dense_matrices.hpp"

#include <petscblaslapack.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "common/eigen_every.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

PetscInt first_row(Mat A)
{
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(A, &first, nullptr));
  return first;
}

/// A count of MPI is an int.
template <typename Work>
void for_pieces(std::span<double> values, const Work& work)
{
  constexpr std::size_t piece = std::size_t(1) << 28;
  for (std::size_t at = 0; at < values.size(); at += piece)
    work(values.data() + at, static_cast<int>(std::min(piece, values.size() - at)));
}

}  // namespace

void sum_over_ranks(std::span<double> values, MPI_Comm comm)
{
  for_pieces(values, [&](double* piece, int n) {
    MPI_Allreduce(MPI_IN_PLACE, piece, n, MPI_DOUBLE, MPI_SUM, comm);
  });
}

void broadcast_numbers(std::span<double> values, MPI_Comm comm)
{
  for_pieces(values, [&](double* piece, int n) { MPI_Bcast(piece, n, MPI_DOUBLE, 0, comm); });
}

double value_of_first_rank(double value, MPI_Comm comm)
{
  MPI_Bcast(&value, 1, MPI_DOUBLE, 0, comm);
  return value;
}

LocalRows::LocalRows(Mat dense) : dense_(dense)
{
  petsc::check(MatGetLocalSize(dense_, &n_rows_, nullptr));
  petsc::check(MatGetSize(dense_, nullptr, &n_cols_));
  petsc::check(MatDenseGetLDA(dense_, &lda_));
  petsc::check(MatDenseGetArrayRead(dense_, &values_));
}

LocalRows::~LocalRows()
{
  MatDenseRestoreArrayRead(dense_, &values_);
}

petsc::Matrix uninitialized_dense(Mat A, Eigen::Index n_columns)
{
  PetscInt n_local = 0, n = 0;
  petsc::check(MatGetLocalSize(A, &n_local, nullptr));
  petsc::check(MatGetSize(A, &n, nullptr));
  petsc::Matrix dense;
  PetscScalar placeholder = 0.0;  // keeps PETSc from allocating
  petsc::check(MatCreateDense(petsc::communicator(A), n_local, PETSC_DECIDE, n,
                              static_cast<PetscInt>(n_columns), &placeholder, dense.put()));
  PetscScalar* values = nullptr;
  petsc::check(PetscMalloc1(std::max<std::size_t>(std::size_t(n_local) * n_columns, 1), &values));
  petsc::check(MatDenseReplaceArray(dense, values));  // which owns them now
  return dense;
}

PetscInt columns_at_a_time(Mat A, PetscInt most)
{
  constexpr PetscInt panel = 8;
  constexpr double long_column = 1 << 19;  // 32 of them take 128 MiB
  PetscInt n = 0;
  petsc::check(MatGetSize(A, &n, nullptr));
  const double rows = std::max(1.0, double(n) / petsc::size(petsc::communicator(A)));
  const auto n_panels = static_cast<PetscInt>(most * long_column / rows / panel);
  return std::clamp(panel * n_panels, most / 4, most);
}

namespace {

/// Rows of some columns in the memory, column-major.
struct Columns {
  const double* values;
  PetscBLASInt n_rows, n_cols, leading_dimension;
};

MatrixXd product_of_columns(const Columns& x, const Columns& y)
{
  MatrixXd product = MatrixXd::Zero(x.n_cols, y.n_cols);
  const PetscScalar one = 1.0, zero = 0.0;
  if (x.n_rows > 0 && product.size() > 0) {
    BLASgemm_("T", "N", &x.n_cols, &y.n_cols, &x.n_rows, &one, x.values, &x.leading_dimension,
              y.values, &y.leading_dimension, &zero, product.data(), &x.n_cols);
  }
  return product;
}

Columns columns_of(const LocalRows& rows)
{
  return {.values = rows.values(),
          .n_rows = rows.n_rows(),
          .n_cols = rows.n_cols(),
          .leading_dimension = rows.leading_dimension()};
}

Columns columns_of(const Eigen::Ref<const MatrixXd>& A)
{
  return {.values = A.data(),
          .n_rows = static_cast<PetscBLASInt>(A.rows()),
          .n_cols = static_cast<PetscBLASInt>(A.cols()),
          .leading_dimension = std::max<PetscBLASInt>(PetscBLASInt(A.outerStride()), 1)};
}

}  // namespace

MatrixXd inner_product(Mat X, Mat Y)
{
  MatrixXd product = [&] {
    const LocalRows x(X), y(Y);
    return product_of_columns(columns_of(x), columns_of(y));
  }();
  sum_over_ranks(values_of(product), petsc::communicator(X));
  return product;
}

MatrixXd gram(Mat X)
{
  MatrixXd G = [&] {
    const LocalRows x(X);
    const Columns columns = columns_of(x);
    MatrixXd upper = MatrixXd::Zero(columns.n_cols, columns.n_cols);
    const PetscScalar one = 1.0, zero = 0.0;
    if (columns.n_rows > 0 && columns.n_cols > 0) {
      BLASsyrk_("U", "T", &columns.n_cols, &columns.n_rows, &one, columns.values,
                &columns.leading_dimension, &zero, upper.data(), &columns.n_cols);
    }
    return MatrixXd(upper.selfadjointView<Eigen::Upper>());
  }();
  sum_over_ranks(values_of(G), petsc::communicator(X));
  return G;
}

MatrixXd inner_product(const Eigen::Ref<const MatrixXd>& X, const Eigen::Ref<const MatrixXd>& Y)
{
  return product_of_columns(columns_of(X), columns_of(Y));
}

std::vector<double> column_products(Mat X, Mat Y)
{
  const LocalRows x(X), y(Y);
  std::vector<double> products(x.n_cols(), 0.0);
  for (PetscInt k = 0; k < x.n_cols(); ++k) {
    const double* x_k = x.values() + std::size_t(k) * x.leading_dimension();
    const double* y_k = y.values() + std::size_t(k) * y.leading_dimension();
    products[k] = std::inner_product(x_k, x_k + x.n_rows(), y_k, 0.0);
  }
  sum_over_ranks(products, petsc::communicator(X));
  return products;
}

namespace {

/// The rows of S that are not zero.
std::vector<Eigen::Index> rows_in_use(const MatrixXd& S)
{
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < S.rows(); ++i)
    if (!S.row(i).isZero(0.0)) rows.push_back(i);
  return rows;
}

/// Rows of a dense matrix that may be written.
struct Target {
  double* values;
  PetscBLASInt leading_dimension;
};

/// Y <- Y + alpha X S with some columns of X, copied some rows at a time; rows in which these
/// columns are zero are not touched.
void add_product_of_columns(double alpha, const LocalRows& X,
                            const std::vector<Eigen::Index>& columns, const MatrixXd& S,
                            const Target& Y)
{
  constexpr PetscInt piece = 512;  // with some hundred columns in a second-level cache
  const PetscScalar one = 1.0;
  const auto n = static_cast<PetscBLASInt>(S.cols()), k = static_cast<PetscBLASInt>(columns.size());
  const MatrixXd factors = S(columns, every);
  std::vector<double> rows(std::size_t(piece) * columns.size());
  for (PetscInt at = 0; at < X.n_rows(); at += piece) {
    const PetscBLASInt m = std::min(piece, X.n_rows() - at);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      std::copy_n(X.values() + at + std::size_t(columns[j]) * X.leading_dimension(), m,
                  rows.data() + j * std::size_t(m));
    }
    const std::span copied(rows.data(), std::size_t(m) * columns.size());
    if (std::ranges::all_of(copied, [](double x) { return x == 0.0; })) continue;
    BLASgemm_("N", "N", &m, &n, &k, &alpha, rows.data(), &m, factors.data(), &k, &one,
              Y.values + at, &Y.leading_dimension);
  }
}

}  // namespace

void add_product(double alpha, Mat X, const MatrixXd& S, Mat Y)
{
  const LocalRows x(X);
  PetscScalar* y = nullptr;
  PetscInt ldy = 0;
  petsc::check(MatDenseGetLDA(Y, &ldy));
  petsc::check(MatDenseGetArray(Y, &y));
  const PetscBLASInt m = x.n_rows();
  const auto n = static_cast<PetscBLASInt>(S.cols());
  const auto k = static_cast<PetscBLASInt>(S.rows());
  const PetscBLASInt ldx = x.leading_dimension();
  const PetscScalar one = 1.0;
  const Target target{.values = y, .leading_dimension = ldy};
  const std::vector<Eigen::Index> used = rows_in_use(S);
  if (4 * used.size() < 3 * std::size_t(k)) {
    if (n > 0 && !used.empty()) add_product_of_columns(alpha, x, used, S, target);
  } else if (m > 0 && n > 0 && k > 0) {
    BLASgemm_("N", "N", &m, &n, &k, &alpha, x.values(), &ldx, S.data(), &k, &one, y,
              &target.leading_dimension);
  }
  petsc::check(MatDenseRestoreArray(Y, &y));
}

void add_sparse_product(Mat A, const MatrixXd& S, Mat Y)
{
  PetscInt first = 0;
  PetscInt ld = 0;
  PetscScalar* y = nullptr;
  petsc::check(MatGetOwnershipRange(Y, &first, nullptr));
  petsc::check(MatDenseGetLDA(Y, &ld));
  petsc::check(MatDenseGetArray(Y, &y));
  for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
    for (PetscInt j = 0; j < S.cols(); ++j)
      y[row - first + std::size_t(j) * ld] += value * S(column, j);
  });
  petsc::check(MatDenseRestoreArray(Y, &y));
}

MatrixXd inner_product_sparse(Mat X, Mat A)
{
  PetscInt n_cols = 0;
  petsc::check(MatGetSize(A, nullptr, &n_cols));
  MatrixXd product = MatrixXd::Zero(LocalRows(X).n_cols(), n_cols);
  {
    const LocalRows x(X);
    const PetscInt first = first_row(A);
    for_local_entries(A, [&](PetscInt row, PetscInt column, double value) {
      for (PetscInt i = 0; i < x.n_cols(); ++i) product(i, column) += x(row - first, i) * value;
    });
  }
  sum_over_ranks(values_of(product), petsc::communicator(X));
  return product;
}

MatrixXd replicate(Mat A)
{
  PetscInt n_rows = 0;
  PetscInt n_cols = 0;
  petsc::check(MatGetSize(A, &n_rows, &n_cols));
  MatrixXd dense = MatrixXd::Zero(n_rows, n_cols);
  for_local_entries(
      A, [&](PetscInt row, PetscInt column, double value) { dense(row, column) = value; });
  sum_over_ranks(values_of(dense), petsc::communicator(A));
  return dense;
}

}  // namespace chladni::linear
