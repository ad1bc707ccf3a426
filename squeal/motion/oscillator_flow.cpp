#include "squeal/motion/oscillator_flow.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace chladni::squeal {
namespace {

/// exp(time [0 omega; -omega -C]) acts on (omega q, v), which is well scaled; turned into (q, v).
Eigen::MatrixXd exact_flow(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double time)
{
  const Eigen::Index n = omega.size();
  const Eigen::MatrixXd Omega = omega.asDiagonal();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << Eigen::MatrixXd::Zero(n, n), Omega, -Omega, -C;
  Eigen::MatrixXd flow = (time * A).exp();
  flow.topRightCorner(n, n) = omega.cwiseInverse().asDiagonal() * flow.topRightCorner(n, n);
  flow.bottomLeftCorner(n, n) *= Omega;
  flow.topLeftCorner(n, n) = omega.cwiseInverse().asDiagonal() * flow.topLeftCorner(n, n) * Omega;
  return flow;
}

}  // namespace

OscillatorFlow::OscillatorFlow(const Eigen::VectorXd& omega, const Eigen::MatrixXd& C, double time)
    : coupled_(!C.isDiagonal(1e-14)), qq_(omega.size()), qv_(qq_), vq_(qq_), vv_(qq_)
{
  if (coupled_) {
    flow_ = exact_flow(omega, C, time);
    return;
  }
  for (Eigen::Index i = 0; i < omega.size(); ++i) {
    const Eigen::Matrix2d block = exact_flow(omega.segment(i, 1), C.block(i, i, 1, 1), time);
    qq_[i] = block(0, 0);
    qv_[i] = block(0, 1);
    vq_[i] = block(1, 0);
    vv_[i] = block(1, 1);
  }
}

void OscillatorFlow::advance(ModalState& x) const
{
  const Eigen::Index n = x.q.size();
  if (coupled_) {
    const Eigen::VectorXd q = flow_.topLeftCorner(n, n) * x.q + flow_.topRightCorner(n, n) * x.v;
    x.v = flow_.bottomLeftCorner(n, n) * x.q + flow_.bottomRightCorner(n, n) * x.v;
    x.q = q;
    return;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double q = x.q[i], v = x.v[i];
    x.q[i] = qq_[i] * q + qv_[i] * v;
    x.v[i] = vq_[i] * q + vv_[i] * v;
  }
}

void OscillatorFlow::advance(ModalColumns& x) const
{
  const Eigen::Index n = x.q.rows();
  if (coupled_) {
    const Eigen::MatrixXd q = flow_.topLeftCorner(n, n) * x.q + flow_.topRightCorner(n, n) * x.v;
    x.v = flow_.bottomLeftCorner(n, n) * x.q + flow_.bottomRightCorner(n, n) * x.v;
    x.q = q;
    return;
  }
  const Eigen::MatrixXd q = qq_.matrix().asDiagonal() * x.q + qv_.matrix().asDiagonal() * x.v;
  x.v = vq_.matrix().asDiagonal() * x.q + vv_.matrix().asDiagonal() * x.v;
  x.q = q;
}

}  // namespace chladni::squeal
