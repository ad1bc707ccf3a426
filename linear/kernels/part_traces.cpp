#include "linear/kernels/part_traces.hpp"

#include <vector>

#include "linear/kernels/decoupled_rows.hpp"
#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"

namespace chladni::linear {

namespace {

using Eigen::MatrixXd;

/// The number of its part for each row of this rank.
std::vector<PetscInt> part_of_rows(const std::vector<petsc::IndexSet>& parts, Mat M)
{
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(M, &first, &last));
  std::vector<PetscInt> part_of(std::size_t(last - first), 0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    PetscInt n = 0;
    const PetscInt* rows = nullptr;
    petsc::check(ISGetLocalSize(parts[p], &n));
    petsc::check(ISGetIndices(parts[p], &rows));
    for (PetscInt i = 0; i < n; ++i)
      part_of[std::size_t(rows[i] - first)] = static_cast<PetscInt>(p);
    petsc::check(ISRestoreIndices(parts[p], &rows));
  }
  return part_of;
}

/// [parts x columns] x^T M x of each part.
MatrixXd masses(const std::vector<PetscInt>& part_of, PetscInt n_parts, Mat M, Mat X)
{
  const petsc::Matrix MX = sparse_product(M, X);
  const LocalRows x(X), mx(MX);
  MatrixXd sums = MatrixXd::Zero(n_parts, x.n_cols());
  for (PetscInt j = 0; j < x.n_cols(); ++j)
    for (PetscInt i = 0; i < x.n_rows(); ++i)
      sums(part_of[std::size_t(i)], j) += x(i, j) * mx(i, j);
  sum_over_ranks(values_of(sums), petsc::communicator(M));
  return sums;
}

}  // namespace

void clear_part_traces(Mat K, Mat M, Mat X)
{
  constexpr double trace = 1e-20;
  const std::vector<petsc::IndexSet> parts = decoupled_rows(K, M);
  if (parts.empty()) return;
  const std::vector<PetscInt> part_of = part_of_rows(parts, M);
  const MatrixXd mass = masses(part_of, static_cast<PetscInt>(parts.size()), M, X);
  PetscInt lda = 0;
  PetscScalar* values = nullptr;
  petsc::check(MatDenseGetLDA(X, &lda));
  petsc::check(MatDenseGetArray(X, &values));
  for (Eigen::Index j = 0; j < mass.cols(); ++j) {
    const double whole = mass.col(j).sum();
    for (std::size_t i = 0; i < part_of.size(); ++i)
      if (mass(part_of[i], j) < trace * whole) values[i + std::size_t(j) * std::size_t(lda)] = 0.0;
  }
  petsc::check(MatDenseRestoreArray(X, &values));
}

}  // namespace chladni::linear
