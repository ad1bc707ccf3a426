#include "linear/kernels/orthonormalisation.hpp"

#include <cmath>
#include <cstdint>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_matrices.hpp"

namespace chladni::linear {

using Eigen::MatrixXd;

namespace {

/// D^-1 G D^-1 with the sizes on the diagonal of D.
MatrixXd scaled(const MatrixXd& G, const std::vector<double>& sizes)
{
  MatrixXd S = G;
  for (PetscInt j = 0; j < G.cols(); ++j)
    for (PetscInt i = 0; i < G.rows(); ++i) S(i, j) /= sizes[i] * sizes[j];
  return S;
}

}  // namespace

Orthonormalisation orthonormalisation(const Eigen::MatrixXd& G, const std::vector<double>& sizes,
                                      double least, MPI_Comm comm)
{
  const auto n = static_cast<PetscInt>(G.rows());
  const SymmetricEigen eigen = symmetric_eigen(scaled(G, sizes), comm);
  const auto value = [&](PetscInt k) { return eigen.values[n - 1 - k]; };  // descending
  PetscInt r = 0;
  while (r < n && value(r) > least * least) ++r;
  Orthonormalisation result{.to_Q = Eigen::MatrixXd(n, r),
                            .R = Eigen::MatrixXd(r, n),
                            .left_out = Eigen::MatrixXd(n - r, n),
                            .shortest = 1.0,
                            .condition = 1.0,
                            .least_square = n > 0 ? value(n - 1) : 0.0,
                            .least_direction = Eigen::MatrixXd(n, 1)};
  for (PetscInt i = 0; i < n; ++i) result.least_direction(i, 0) = eigen.vectors(i, 0) / sizes[i];
  for (PetscInt k = 0; k < n; ++k) {
    const double length = std::sqrt(std::abs(value(k)));
    for (PetscInt i = 0; i < n; ++i) {
      const double e = eigen.vectors(i, n - 1 - k);
      (k < r ? result.R(k, i) : result.left_out(k - r, i)) = e * length * sizes[i];
      if (k < r) result.to_Q(i, k) = e / (length * sizes[i]);
    }
  }
  if (r == 0) return result;
  result.shortest = std::sqrt(value(r - 1));
  result.condition = std::sqrt(value(0)) / result.shortest;
  return result;
}

std::vector<double> column_lengths(const Eigen::MatrixXd& A)
{
  std::vector<double> lengths(A.cols(), 0.0);
  for (PetscInt j = 0; j < A.cols(); ++j) {
    for (PetscInt i = 0; i < A.rows(); ++i) lengths[j] += A(i, j) * A(i, j);
    lengths[j] = std::sqrt(lengths[j]);
  }
  return lengths;
}

namespace {

/// D X with D the diagonal of M.
petsc::Matrix times_diagonal(Mat X, Mat M)
{
  petsc::Matrix DX;
  petsc::check(MatDuplicate(X, MAT_COPY_VALUES, DX.put()));
  petsc::check(MatDiagonalScale(DX, diagonal(M), nullptr));
  return DX;
}

}  // namespace

std::vector<double> diagonal_terms(Mat X, Mat M)
{
  return column_products(X, times_diagonal(X, M));
}

petsc::Matrix columns_with_mass(Mat X, Mat MX, Mat M)
{
  constexpr double round_off = 1e-12;
  const std::vector<double> mass = column_products(X, MX);
  const std::vector<double> terms = diagonal_terms(X, M);
  std::vector<PetscInt> with_mass;
  for (std::size_t k = 0; k < mass.size(); ++k)
    if (mass[k] > round_off * terms[k]) with_mass.push_back(static_cast<PetscInt>(k));
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(std::ssize(mass), std::ssize(with_mass));
  for (PetscInt j = 0; j < S.cols(); ++j) S(with_mass[j], j) = 1.0;
  petsc::Matrix chosen = uninitialized_dense(X, S.cols());
  petsc::check(MatZeroEntries(chosen));
  add_product(1.0, X, S, chosen);
  return chosen;
}

void normalise_columns(Mat X, Mat MX)
{
  const std::vector<double> squared = column_products(X, MX);
  const PetscInt n_local = LocalRows(X).n_rows();
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetArray(X, &values));
  for (std::size_t k = 0; k < squared.size(); ++k) {
    const double factor = squared[k] > 0.0 ? 1.0 / std::sqrt(squared[k]) : 0.0;
    for (PetscInt i = 0; i < n_local; ++i) values[i + k * n_local] *= factor;
  }
  petsc::check(MatDenseRestoreArray(X, &values));
}

namespace {

/// Deterministic numbers in (-1, 1) from the global row and the column (splitmix64).
double random_number(std::uint64_t row, std::uint64_t column)
{
  std::uint64_t z = row * 0x9E3779B97F4A7C15ULL + column * 0xD1B54A32D192ED03ULL + 1;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return 2.0 * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53) - 1.0;
}

}  // namespace

void fill_with_random_numbers(Mat block, PetscInt first_number)
{
  PetscScalar* values = nullptr;
  PetscInt first = 0, n_local = 0, n_columns = 0;
  petsc::check(MatGetOwnershipRange(block, &first, nullptr));
  petsc::check(MatGetLocalSize(block, &n_local, nullptr));
  petsc::check(MatGetSize(block, nullptr, &n_columns));
  petsc::check(MatDenseGetArrayWrite(block, &values));
  for (PetscInt j = 0; j < n_columns; ++j)
    for (PetscInt i = 0; i < n_local; ++i)
      values[i + std::size_t(j) * n_local] = random_number(first + i, first_number + j);
  petsc::check(MatDenseRestoreArrayWrite(block, &values));
}

}  // namespace chladni::linear
