#include "linear/dense/deflated_factor.hpp"

#include <limits>

#include "common/error.hpp"

namespace chladni::linear {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// Pi^T K Pi with Pi = I - R R^T M: K without the round-off that it has along its zero-energy
/// vectors. Where these are most of the coordinates, as of a body with a single attachment node,
/// round-off is all that stands there, and may be of either sign.
MatrixXd without_zero_energy(const MatrixXd& K, const MatrixXd& MR, const MatrixXd& R)
{
  const MatrixXd KR = K * R;
  MatrixXd K_d = K - MR * KR.transpose() - KR * MR.transpose();
  K_d += MR * (R.transpose() * KR) * MR.transpose();
  return 0.5 * (K_d + K_d.transpose());
}

/// A pivot of round-off may be of either sign. Where it is positive, its motion L^T v = e_i is
/// refused unless its ratio of stiffness and mass is that of a low mode: what is softly supported
/// is no mechanism.
void refuse_massless_mechanism(const Eigen::LLT<MatrixXd>& B, const VectorXd& diagonal,
                               const MatrixXd& M, double sigma)
{
  const double round_off =
      4.0 * static_cast<double>(M.rows()) * std::numeric_limits<double>::epsilon();
  const MatrixXd& L = B.matrixLLT();
  for (Eigen::Index i = 0; i < L.rows(); ++i) {
    if (L(i, i) * L(i, i) > round_off * diagonal[i]) continue;
    const VectorXd v = B.matrixU().solve(VectorXd::Unit(L.rows(), i));  // of the stiffness 1
    if (sigma * v.dot(M * v) > 1.0) continue;
    throw Error(
        "eigenmodes: a motion has neither stiffness nor mass, so the pencil (K, M) is singular; "
        "give its DOFs stiffness or mass, or leave them out");
  }
}

}  // namespace

double deflation_shift(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  const MatrixXd K_d = without_zero_energy(K, M * R, R);
  const double without_mass = M.size() > 0 ? 1e-14 * M.diagonal().maxCoeff() : 0.0;
  const VectorXd ratio = (M.diagonal().array() > without_mass)
                             .select(K_d.diagonal().array() / M.diagonal().array(), 0.0);
  const double largest = ratio.size() > 0 ? ratio.maxCoeff() : 0.0;
  if (largest <= 0.0) return 1.0;
  return (ratio.array() > 1e-10 * largest).select(ratio, largest).minCoeff();
}

Eigen::LLT<MatrixXd> deflated_factor(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                                     double sigma)
{
  const MatrixXd MR = M * R;
  const MatrixXd K_d = without_zero_energy(K, MR, R);
  const MatrixXd supported = K_d + sigma * MR * MR.transpose();
  Eigen::LLT<MatrixXd> B(supported);
  if (B.info() != Eigen::Success) {
    throw Error(
        "eigenmodes: the stiffness matrix is singular beyond the rigid-body motions, or indefinite;"
        " is the structure in one piece, without mechanisms, and no attachment node so close to "
        "another"
        " that round-off is all there is between them?");
  }
  refuse_massless_mechanism(B, supported.diagonal(), M, sigma);
  return B;
}

}  // namespace chladni::linear
