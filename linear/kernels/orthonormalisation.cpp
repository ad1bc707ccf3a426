#include "linear/kernels/orthonormalisation.hpp"

#include <cmath>

#include "linear/kernels/symmetric_eigen.hpp"

namespace chladni::linear {

namespace {

/// D^-1 G D^-1 with the sizes on the diagonal of D.
SmallMatrix scaled(const SmallMatrix& G, const std::vector<double>& sizes)
{
  SmallMatrix S = G;
  for (PetscInt j = 0; j < G.n_cols; ++j) {
    for (PetscInt i = 0; i < G.n_rows; ++i) S(i, j) /= sizes[i] * sizes[j];
  }
  return S;
}

}  // namespace

Orthonormalisation orthonormalisation(const SmallMatrix& G, const std::vector<double>& sizes,
                                      double least, MPI_Comm comm)
{
  const PetscInt n = G.n_rows;
  const SymmetricEigen eigen = symmetric_eigen(scaled(G, sizes), comm);
  const auto value = [&](PetscInt k) { return eigen.values[n - 1 - k]; };  // descending
  PetscInt r = 0;
  while (r < n && value(r) > least * least) ++r;
  Orthonormalisation result{
      .to_Q = {n, r}, .R = {r, n}, .left_out = {n - r, n}, .shortest = 1.0, .condition = 1.0};
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

std::vector<double> column_lengths(const SmallMatrix& A)
{
  std::vector<double> lengths(A.n_cols, 0.0);
  for (PetscInt j = 0; j < A.n_cols; ++j) {
    for (PetscInt i = 0; i < A.n_rows; ++i) lengths[j] += A(i, j) * A(i, j);
    lengths[j] = std::sqrt(lengths[j]);
  }
  return lengths;
}

}  // namespace chladni::linear
