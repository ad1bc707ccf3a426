#include "fmu/propagator.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace chladni::fmu {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// In coordinates s q with s = max(omega, 1/h), so that A h has entries of the size of omega h
/// instead of (omega h)^2.
Propagator dense_propagator(const VectorXd& omega, const MatrixXd& C, double h)
{
  const Index n = omega.size();
  const VectorXd s = omega.cwiseMax(1.0 / h);
  MatrixXd A = MatrixXd::Zero(3 * n, 3 * n);
  A.block(0, n, n, n) = s.asDiagonal();
  A.block(n, 0, n, n) = (-omega.cwiseAbs2().cwiseQuotient(s)).asDiagonal();
  A.block(n, n, n, n) = -C;
  A.block(n, 2 * n, n, n).setIdentity();
  const MatrixXd exponential = (A * h).exp();
  VectorXd scale = VectorXd::Ones(2 * n);
  scale.head(n) = s;
  return {.from_state = scale.cwiseInverse().asDiagonal() *
                        exponential.topLeftCorner(2 * n, 2 * n) * scale.asDiagonal(),
          .from_force = scale.cwiseInverse().asDiagonal() * exponential.topRightCorner(2 * n, n)};
}

}  // namespace

Propagator propagator(const VectorXd& omega, const MatrixXd& C, double h)
{
  const Index n = omega.size();
  if (n == 0 || !C.isDiagonal(0.0)) return dense_propagator(omega, C, h);
  Propagator all{.from_state = MatrixXd::Zero(2 * n, 2 * n),
                 .from_force = MatrixXd::Zero(2 * n, n)};
  for (Index i = 0; i < n; ++i) {
    const Propagator one = dense_propagator(omega.segment(i, 1), C.block(i, i, 1, 1), h);
    for (Index row = 0; row < 2; ++row) {
      for (Index col = 0; col < 2; ++col)
        all.from_state(row * n + i, col * n + i) = one.from_state(row, col);
      all.from_force(row * n + i, i) = one.from_force(row, 0);
    }
  }
  return all;
}

}  // namespace chladni::fmu
