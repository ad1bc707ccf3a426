#include "reduce/growing_model.hpp"

#include <petscblaslapack.h>

#include <algorithm>

#include "linear/kernels/small_matrices.hpp"
#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

constexpr PetscInt block_columns = 64;  // of the solves: bounds the memory

/// B_j = M_ss (Psi - Phi P)_j + M_sm,j of columns first .. last - 1.
petsc::Matrix deflated_inertia(const GrowingModel::System& system, Mat Phi, const MatrixXd& P,
                               PetscInt first)
{
  const PetscInt last = first + static_cast<PetscInt>(P.cols());
  petsc::Matrix shape, B = linear::uninitialized_dense(system.M.ss, P.cols());
  petsc::check(
      MatDuplicate(linear::ColumnRange(system.Psi, first, last), MAT_COPY_VALUES, shape.put()));
  linear::add_product(-1.0, Phi, P, shape);
  linear::SparseProduct(system.M.ss).apply(shape, B);
  PetscInt first_row = 0;
  PetscScalar* values = nullptr;
  petsc::check(MatGetOwnershipRange(B, &first_row, nullptr));
  petsc::check(MatDenseGetArray(B, &values));
  const PetscInt n_local = linear::LocalRows(shape).n_rows();
  linear::for_local_entries(system.M.sm, [&](PetscInt row, PetscInt column, double value) {
    if (column < first || column >= last) return;
    values[row - first_row + std::size_t(column - first) * n_local] += value;
  });
  petsc::check(MatDenseRestoreArray(B, &values));
  return B;
}

}  // namespace

GrowingModel::GrowingModel(const System& system)
    : system_(system),
      K_G_(guyan_stiffness(system.Psi, system.K)),
      M_G_(guyan_mass(system.Psi, system.M)),
      P_(0, M_G_.rows())
{}

/// G = (Psi - Phi P)^T M_ss Z + M_ms Z with Z = K_ss^-1 (M_ss (Psi - Phi P) + M_sm): symmetric, its
/// upper triangle is computed.
void GrowingModel::start_errors(Mat Phi)
{
  const auto n_m = static_cast<PetscInt>(M_G_.rows());
  n_first_ = static_cast<PetscInt>(P_.rows());
  G_ = MatrixXd::Zero(n_m, n_m);
  for (PetscInt first = 0; first < n_m; first += block_columns) {
    linear::report_progress(double(first) / n_m);
    const PetscInt last = std::min(first + block_columns, n_m);
    const MatrixXd P = P_.middleCols(first, last - first);
    const petsc::Matrix B = deflated_inertia(system_, Phi, P, first);
    const petsc::Matrix Z = linear::uninitialized_dense(system_.M.ss, last - first);
    petsc::check(MatMatSolve(system_.K_ss.factor(), B, Z));
    const petsc::Matrix MZ = linear::uninitialized_dense(system_.M.ss, last - first);
    linear::SparseProduct(system_.M.ss).apply(Z, MZ);
    const MatrixXd Psi_MZ = linear::inner_product(linear::ColumnRange(system_.Psi, 0, last), MZ);
    const MatrixXd Phi_MZ = linear::inner_product(Phi, MZ);
    const MatrixXd Z_M_sm = linear::inner_product_sparse(Z, system_.M.sm);
    for (PetscInt j = first; j < last; ++j) {
      for (PetscInt i = 0; i <= j; ++i) {
        double deflation = 0.0;
        for (PetscInt k = 0; k < n_first_; ++k) deflation += P_(k, i) * Phi_MZ(k, j - first);
        G_(i, j) = G_(j, i) = Psi_MZ(i, j - first) - deflation + Z_M_sm(j - first, i);
      }
    }
  }
}

void GrowingModel::append(Mat Phi, const std::vector<double>& omega)
{
  const bool is_first = omega_.empty();
  P_ = linear::stacked(P_, inertial_coupling(Phi, system_.Psi, system_.M));
  omega_.insert(omega_.end(), omega.begin(), omega.end());
  if (is_first) start_errors(Phi);
}

ReducedModel GrowingModel::model(PetscInt n) const
{
  return join(K_G_, M_G_, P_, {omega_.begin(), omega_.begin() + n});
}

/// G_n
MatrixXd GrowingModel::G(PetscInt n) const
{
  MatrixXd G_n = G_;
  const double sign = n > n_first_ ? -1.0 : 1.0;
  for (PetscInt k = std::min(n, n_first_); k < std::max(n, n_first_); ++k) {
    const double factor = sign / (omega_[k] * omega_[k]);
    for (PetscInt j = 0; j < G_n.cols(); ++j)
      for (PetscInt i = 0; i < G_n.rows(); ++i) G_n(i, j) += factor * P_(k, i) * P_(k, j);
  }
  return G_n;
}

ReducedModel GrowingModel::heavier_model(PetscInt n, double sigma, double lambda_left_out) const
{
  ReducedModel heavier = model(n);
  const MatrixXd G_n = G(n);
  const double factor = sigma / (1.0 - sigma / lambda_left_out);
  heavier.M.topLeftCorner(G_n.rows(), G_n.cols()) += factor * G_n;
  return heavier;
}

std::vector<double> GrowingModel::error_estimates(const ReducedPairs& pairs, PetscInt n) const
{
  const Eigen::Index n_m = M_G_.rows();
  std::vector<double> eta2;
  for (PetscInt j = 0; j < pairs.X.cols(); ++j) {
    double sum = 0.0;
    for (PetscInt c = 0; c < n_m; ++c)
      for (PetscInt r = 0; r < n_m; ++r) sum += pairs.X(r, j) * G_(r, c) * pairs.X(c, j);
    for (PetscInt k = std::min(n, n_first_); k < std::max(n, n_first_); ++k) {
      double P_x = 0.0;
      for (PetscInt i = 0; i < n_m; ++i) P_x += P_(k, i) * pairs.X(i, j);
      sum += (n > n_first_ ? -1.0 : 1.0) * P_x * P_x / (omega_[k] * omega_[k]);
    }
    eta2.push_back(std::max(0.0, pairs.lambda[j] * sum));
  }
  return eta2;
}

}  // namespace chladni::reduce
