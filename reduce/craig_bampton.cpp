#include "reduce/craig_bampton.hpp"

#include <algorithm>

#include "linear/kernels/sparse_product.hpp"
#include "linear/progress.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

constexpr PetscInt block_columns = 64;  // at a time: bounds the memory, enough for dgemm

/// Calls with the first and the last + 1 of some columns, block after block.
template <typename Work>
void for_column_blocks(PetscInt n_columns, const Work& work)
{
  for (PetscInt first = 0; first < n_columns; first += block_columns)
    work(first, std::min(first + block_columns, n_columns));
}

PetscInt n_columns(Mat A)
{
  PetscInt n = 0;
  petsc::check(MatGetSize(A, nullptr, &n));
  return n;
}

/// Psi^T M_ss Psi
MatrixXd slave_mass(Mat Psi, Mat M_ss)
{
  const PetscInt n_m = n_columns(Psi);
  MatrixXd Psi_M_Psi = MatrixXd::Zero(n_m, n_m);
  const linear::SparseProduct product(M_ss);
  for_column_blocks(n_m, [&](PetscInt first, PetscInt last) {
    linear::report_progress(double(first) / n_m);
    const petsc::Matrix M_Psi = linear::uninitialized_dense(M_ss, last - first);
    product.apply(linear::ColumnRange(Psi, first, last), M_Psi);
    // The upper triangle of Psi^T M Psi is enough.
    Psi_M_Psi.block(0, first, last, last - first) =
        linear::inner_product(linear::ColumnRange(Psi, 0, last), M_Psi);
  });
  return Psi_M_Psi.selfadjointView<Eigen::Upper>();
}

}  // namespace

MatrixXd guyan_mass(Mat Psi, const Blocks& M)
{
  const MatrixXd Psi_M_Psi = slave_mass(Psi, M.ss);
  const MatrixXd M_mm = linear::replicate(M.mm), Psi_M_sm = linear::inner_product_sparse(Psi, M.sm);
  MatrixXd M_G(M_mm.rows(), M_mm.cols());
  M_G.triangularView<Eigen::Upper>() =
      0.5 * (M_mm + M_mm.transpose()) + Psi_M_sm + Psi_M_sm.transpose() + Psi_M_Psi;
  return M_G.selfadjointView<Eigen::Upper>();
}

MatrixXd inertial_coupling(Mat Phi, Mat Psi, const Blocks& M)
{
  MatrixXd P = linear::inner_product_sparse(Phi, M.sm);
  const linear::SparseProduct product(M.ss);
  for_column_blocks(n_columns(Phi), [&](PetscInt first, PetscInt last) {
    const petsc::Matrix M_Phi = linear::uninitialized_dense(M.ss, last - first);
    product.apply(linear::ColumnRange(Phi, first, last), M_Phi);
    P.middleRows(first, last - first) += linear::inner_product(M_Phi, Psi);
  });
  return P;
}

ReducedModel join(const GuyanStiffness& K_G, const MatrixXd& M_G, const MatrixXd& P,
                  std::vector<double> omega)
{
  const Eigen::Index n_m = K_G.K.rows(), n_q = std::ssize(omega);
  MatrixXd K = MatrixXd::Zero(n_m + n_q, n_m + n_q), M = MatrixXd::Identity(n_m + n_q, n_m + n_q);
  K.topLeftCorner(n_m, n_m) = K_G.K;
  M.topLeftCorner(n_m, n_m) = M_G;
  M.bottomLeftCorner(n_q, n_m) = P.topRows(n_q);
  M.topRightCorner(n_m, n_q) = P.topRows(n_q).transpose();
  for (Eigen::Index k = 0; k < n_q; ++k) K(n_m + k, n_m + k) = omega[k] * omega[k];
  return {.K = std::move(K),
          .M = std::move(M),
          .n_masters = static_cast<PetscInt>(n_m),
          .omega = std::move(omega),
          .R = K_G.R};
}

ReducedModel project(const CraigBamptonBasis& Q_CB, const Blocks& K, const Blocks& M)
{
  const GuyanStiffness K_G = guyan_stiffness(Q_CB.Psi, K);
  const MatrixXd M_G = guyan_mass(Q_CB.Psi, M);
  if (!Q_CB.modes) return join(K_G, M_G, MatrixXd(0, M_G.cols()), {});
  return join(K_G, M_G, inertial_coupling(Q_CB.modes->Phi, Q_CB.Psi, M), Q_CB.modes->omega);
}

}  // namespace chladni::reduce
