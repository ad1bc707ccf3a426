#include "sound/element_matrix.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::sound {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

ElementIntegral::ElementIntegral(const LagrangeBasis& basis, double k, int n)
    : dimension_(basis.dimension()), k_(k), n_(n)
{
  // r and the curvature of the elements add to the degree in the meridian plane.
  const int degree = 2 * basis.order() + (dimension_ == 2 ? 2 : 0);
  const Quadrature points = simplex_points(dimension_, degree);
  weights_ = points.weights;
  N_ = basis.values(points.points);
  dN_.resize(dimension_ * N_.rows(), N_.cols());
  for (int d = 0; d < dimension_; ++d) {
    const MatrixXd D = basis.derivatives(points.points, d);
    for (Index q = 0; q < D.rows(); ++q) dN_.row(dimension_ * q + d) = D.row(q);
  }
}

template <class Scalar>
ElementIntegral::Matrix<Scalar> ElementIntegral::integral(const MatrixXd& x,
                                                          const Matrix<Scalar>& stretched) const
{
  using Jacobian = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  const Index n_points = weights_.size();
  Matrix<Scalar> grad(dN_.rows(), dN_.cols()), weighted(dN_.rows(), dN_.cols());
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> mass(n_points);
  for (Index q = 0; q < n_points; ++q) {
    const auto D = dN_.middleRows(dimension_ * q, dimension_);
    const Jacobian J = D * stretched;  // row k: dx / dxi_k
    const double orientation = (D * x).determinant() < 0.0 ? -1.0 : 1.0;
    Scalar weight = weights_[q] * orientation * J.determinant();
    Scalar factor = -k_ * k_;
    if (dimension_ == 2) {
      const Scalar r = (N_.row(q) * stretched.col(0)).value();
      weight *= r;
      factor += double(n_ * n_) / (r * r);
    }
    grad.middleRows(dimension_ * q, dimension_) = J.inverse() * D;
    weighted.middleRows(dimension_ * q, dimension_) =
        weight * grad.middleRows(dimension_ * q, dimension_);
    mass[q] = weight * factor;
  }
  Matrix<Scalar> K = grad.transpose() * weighted;
  K.noalias() += N_.transpose() * (mass.asDiagonal() * N_);
  return K;
}

MatrixXcd ElementIntegral::operator()(const MatrixXd& x, const MatrixXcd& stretched) const
{
  return integral<std::complex<double>>(x, stretched);
}

MatrixXd ElementIntegral::operator()(const MatrixXd& x) const
{
  return integral<double>(x, x);
}

}  // namespace chladni::sound
