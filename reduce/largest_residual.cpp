#include <algorithm>
#include <cmath>

#include "linear/kernels/dense_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "reduce/fixed_interface_modes.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// Squares of the lengths of K phi - lambda M phi and of lambda M phi, column by column.
MatrixXd squared_lengths(Mat K_Phi, Mat M_Phi, const double* omega)
{
  const linear::LocalRows k(K_Phi), m(M_Phi);
  MatrixXd sums = MatrixXd::Zero(2, k.n_cols());
  for (PetscInt j = 0; j < k.n_cols(); ++j) {
    const double lambda = omega[j] * omega[j];
    for (PetscInt i = 0; i < k.n_rows(); ++i) {
      const double inertia = lambda * m(i, j);
      const double difference = k(i, j) - inertia;
      sums(0, j) += difference * difference;
      sums(1, j) += inertia * inertia;
    }
  }
  linear::sum_over_ranks(linear::values_of(sums), petsc::communicator(K_Phi));
  return sums;
}

}  // namespace

double largest_residual(const FixedInterfaceModes& modes, Mat K_ss, Mat M_ss)
{
  const PetscInt most = linear::columns_at_a_time(K_ss);
  const auto n = static_cast<PetscInt>(modes.omega.size());
  double largest = 0.0;
  for (PetscInt first = 0; first < n; first += most) {
    const PetscInt last = std::min(first + most, n);
    const petsc::Matrix K_Phi = linear::uninitialized_dense(K_ss, last - first);
    const petsc::Matrix M_Phi = linear::uninitialized_dense(K_ss, last - first);
    const linear::ColumnRange Phi(modes.Phi, first, last);
    linear::SparseProduct(K_ss).apply(Phi, K_Phi);
    linear::SparseProduct(M_ss).apply(Phi, M_Phi);
    const MatrixXd lengths = squared_lengths(K_Phi, M_Phi, modes.omega.data() + first);
    for (PetscInt j = 0; j < lengths.cols(); ++j)
      largest = std::max(largest, std::sqrt(lengths(0, j) / lengths(1, j)));
  }
  return largest;
}

}  // namespace chladni::reduce
