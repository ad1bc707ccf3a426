#include "reduce/craig_bampton.hpp"

#include <array>

#include "linear/kernels/parted_form.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// @param Psi_M_Psi  Psi^T M_ss Psi
MatrixXd guyan_mass(Mat Psi, const Blocks& M, const MatrixXd& Psi_M_Psi)
{
  const MatrixXd M_mm = linear::replicate(M.mm), Psi_M_sm = linear::inner_product_sparse(Psi, M.sm);
  MatrixXd M_G(M_mm.rows(), M_mm.cols());
  M_G.triangularView<Eigen::Upper>() =
      0.5 * (M_mm + M_mm.transpose()) + Psi_M_sm + Psi_M_sm.transpose() + Psi_M_Psi;
  return M_G.selfadjointView<Eigen::Upper>();
}

}  // namespace

MatrixXd guyan_mass(Mat Psi, const Blocks& M)
{
  return guyan_mass(Psi, M,
                    linear::parted_form(std::array{Psi}, M.ss, linear::FormSymmetry::symmetric));
}

MatrixXd inertial_coupling(Mat Phi, Mat Psi, const Blocks& M)
{
  return linear::inner_product_sparse(Phi, M.sm) + linear::parted_form(Phi, M.ss, Psi);
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
  if (!Q_CB.modes) {
    const MatrixXd M_G = guyan_mass(Q_CB.Psi, M);
    return join(K_G, M_G, MatrixXd(0, M_G.cols()), {});
  }
  const Mat Psi = Q_CB.Psi, Phi = Q_CB.modes->Phi;
  const MatrixXd with_Psi = linear::leading_columns_of_form(std::array{Psi, Phi}, M.ss);
  const Eigen::Index n_m = with_Psi.cols(), n_q = with_Psi.rows() - n_m;
  const MatrixXd P = linear::inner_product_sparse(Phi, M.sm) + with_Psi.bottomRows(n_q);
  return join(K_G, guyan_mass(Psi, M, with_Psi.topRows(n_m)), P, Q_CB.modes->omega);
}

}  // namespace chladni::reduce
