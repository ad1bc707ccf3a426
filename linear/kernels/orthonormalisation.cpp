#include "linear/kernels/orthonormalisation.hpp"

#include <cmath>

#include "linear/kernels/symmetric_eigen.hpp"

namespace chladni::linear {

namespace {

using Eigen::MatrixXd;

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

}  // namespace chladni::linear
