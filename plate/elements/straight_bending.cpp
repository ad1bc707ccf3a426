#include "plate/elements/straight_bending.hpp"

#include <Eigen/LU>

namespace chladni::plate {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

/// d/dxi of polynomials by their coefficients.
MatrixXd derivative(Index n)
{
  MatrixXd D = MatrixXd::Zero(n, n);
  for (Index k = 1; k < n; ++k) D(k - 1, k) = static_cast<double>(k);
  return D;
}

RowVectorXd powers(double xi, Index n)
{
  RowVectorXd p = RowVectorXd::Ones(n);
  for (Index k = 1; k < n; ++k) p[k] = p[k - 1] * xi;
  return p;
}

/// D + a D^3 + a^2 D^5 + ...
MatrixXd rotation_of_deflection(const MatrixXd& D, double a)
{
  MatrixXd sum = MatrixXd::Zero(D.rows(), D.cols()), term = D;
  for (Index k = 1; k < D.rows(); k += 2, term = a * term * D * D) sum += term;
  return sum;
}

}  // namespace

StraightBending::StraightBending(int order, double length, double a) : half_(0.5 * length)
{
  const Index n = 2 * Index{order} + 2;
  const MatrixXd D = derivative(n);
  const MatrixXd B = rotation_of_deflection(D, a / (half_ * half_));
  MatrixXd values(n, n);  // of w and beta l / 2 at the nodes, for each power
  for (Index i = 0; i <= order; ++i) {
    const RowVectorXd at_node = powers(-1.0 + 2.0 * double(i) / order, n);
    values.row(2 * i) = at_node;
    values.row(2 * i + 1) = at_node * B;
  }
  // Without these scales digits are lost where a is large.
  const Eigen::VectorXd scales = values.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
  w_ = scales.asDiagonal() * (values * scales.asDiagonal()).partialPivLu().inverse();
  for (Index i = 1; i < n; i += 2) w_.col(i) *= half_;
  beta_ = B * w_ / half_;
  beta_x_ = D * beta_ / half_;
  beta_xx_ = D * beta_x_ / half_;
}

StraightBending::Forms StraightBending::at(double xi) const
{
  const RowVectorXd p = powers(xi, w_.rows());
  return {.w = p * w_, .beta = p * beta_, .beta_x = p * beta_x_, .beta_xx = p * beta_xx_};
}

}  // namespace chladni::plate
