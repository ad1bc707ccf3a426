#include "linear/kernels/columns_with_mass.hpp"

#include <cmath>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/diagonal.hpp"

namespace chladni::linear {

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

}  // namespace chladni::linear
