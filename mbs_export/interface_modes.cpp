#include "mbs_export/interface_modes.hpp"

#include <fmt/format.h>

#include "linear/dense/orthogonal_factor.hpp"
#include "mbs_export/body_option_error.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double closest_gap = 1e-8;  // relative to omega^2; below it a response is round-off

/// The middle between neglected mode i and the next one below that differs, or above the rigid
/// ones.
double other_frequency(const VectorXd& omega_n, Index i)
{
  for (Index below = i - 1; below >= 0; --below)
    if (omega_n[below] < (1.0 - 1e-4) * omega_n[i]) return 0.5 * (omega_n[below] + omega_n[i]);
  if (omega_n[i] > 0.0) return 0.5 * omega_n[i];
  const auto elastic = (omega_n.array() > 0.0);
  return elastic.any() ? 0.5 * elastic.select(omega_n.array(), omega_n.maxCoeff()).minCoeff() : 1.0;
}

}  // namespace

MatrixXd response_modes(const VectorXd& omega_n, const MatrixXd& g, double Omega_0)
{
  const VectorXd gap = omega_n.array().square() - Omega_0 * Omega_0;
  for (Index i = 0; i < gap.size(); ++i)
    if (std::abs(gap[i]) <= closest_gap * omega_n[i] * omega_n[i]) {
      throw BodyOptionError(
          "interface_modes",
          fmt::format("omega0 = {:.9g} rad/s is the frequency of a neglected mode; take "
                      "omega0 = {:.6g}",
                      Omega_0, other_frequency(omega_n, i)));
    }
  return gap.cwiseInverse().asDiagonal() * g;
}

InterfaceBasis interface_basis(const VectorXd& omega_n, const MatrixXd& responses)
{
  MatrixXd P = responses;
  for (Index j = 0; j < P.cols(); ++j)
    if (const double norm = P.col(j).norm(); norm > 0.0) P.col(j) /= norm;
  if (P.size() == 0) return {MatrixXd(omega_n.size(), 0), VectorXd(0), static_cast<int>(P.cols())};
  Eigen::ColPivHouseholderQR<MatrixXd> qr(P);
  qr.setThreshold(1e-8);
  const MatrixXd V = linear::columns_of_Q(qr, qr.rank());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      MatrixXd(V.transpose() * omega_n.cwiseAbs2().asDiagonal() * V));
  return {V * solver.eigenvectors(), solver.eigenvalues().cwiseMax(0.0).cwiseSqrt(),
          static_cast<int>(P.cols() - qr.rank())};
}

}  // namespace chladni::mbs_export
