#include "sound/helmholtz_element.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::sound {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// Legendre polynomials of 2 x - 1 and their derivatives by x, up to `order`.
struct Legendre {
  VectorXd value, slope;
};

Legendre legendre(double x, int order)
{
  Legendre P{VectorXd::Zero(order + 1), VectorXd::Zero(order + 1)};
  const double t = 2.0 * x - 1.0;
  P.value[0] = 1.0;
  if (order > 0) P.value[1] = t, P.slope[1] = 2.0;
  for (int k = 1; k < order; ++k) {
    P.value[k + 1] = ((2 * k + 1) * t * P.value[k] - k * P.value[k - 1]) / (k + 1);
    P.slope[k + 1] = P.slope[k - 1] + 2.0 * (2 * k + 1) * P.value[k];
  }
  return P;
}

/// All exponents of a total degree up to `order`.
std::vector<std::vector<int>> complete_exponents(int dimension, int order)
{
  if (dimension == 0) return {{}};
  std::vector<std::vector<int>> all;
  for (int k = 0; k <= order; ++k) {
    for (std::vector<int> rest : complete_exponents(dimension - 1, order - k)) {
      rest.push_back(k);
      all.push_back(rest);
    }
  }
  return all;
}

/// Products of Legendre polynomials, [n_points x n]; differentiated along `k` unless k < 0.
MatrixXd products(const MatrixXd& points, const std::vector<std::vector<int>>& exponents, int order,
                  int k)
{
  const auto n = static_cast<Index>(exponents.size());
  MatrixXd P = MatrixXd::Ones(points.rows(), n);
  for (Index i = 0; i < points.rows(); ++i) {
    for (int d = 0; d < points.cols(); ++d) {
      const Legendre L = legendre(points(i, d), order);
      const VectorXd& f = d == k ? L.slope : L.value;
      for (Index j = 0; j < n; ++j) P(i, j) *= f[exponents[std::size_t(j)][std::size_t(d)]];
    }
  }
  return P;
}

}  // namespace

Quadrature gauss_points(int n)
{
  // Golub and Welsch: eigenvalues of the Jacobi matrix of the Legendre polynomials.
  MatrixXd J = MatrixXd::Zero(n, n);
  for (int k = 1; k < n; ++k) J(k, k - 1) = J(k - 1, k) = k / std::sqrt(4.0 * k * k - 1.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(J);
  return {.points = (0.5 + 0.5 * solver.eigenvalues().array()).matrix(),
          .weights = solver.eigenvectors().row(0).transpose().cwiseAbs2()};
}

Quadrature simplex_points(int dimension, int degree)
{
  if (dimension == 1) return gauss_points(degree / 2 + 1);
  // x = (1 - s) eta for eta of the simplex of one dimension less; the Jacobian is
  // (1 - s)^(dimension - 1).
  const Quadrature base = simplex_points(dimension - 1, degree);
  const Quadrature line = gauss_points((degree + dimension - 1) / 2 + 1);
  Quadrature points{MatrixXd(base.weights.size() * line.weights.size(), dimension), {}};
  points.weights.resize(points.points.rows());
  Index at = 0;
  for (Index i = 0; i < line.weights.size(); ++i) {
    const double s = line.points(i, 0);
    for (Index j = 0; j < base.weights.size(); ++j, ++at) {
      points.points.row(at) << (1.0 - s) * base.points.row(j), s;
      points.weights[at] = line.weights[i] * base.weights[j] * std::pow(1.0 - s, dimension - 1);
    }
  }
  return points;
}

std::vector<ReferenceFace> reference_faces(int dimension, int degree)
{
  const Quadrature flat = simplex_points(dimension - 1, degree);
  std::vector<ReferenceFace> faces;
  for (int k = 0; k <= dimension; ++k) {
    const bool slanted = k == dimension;
    ReferenceFace face{
        {MatrixXd(flat.weights.size(), dimension), flat.weights},
        slanted ? VectorXd::Ones(dimension).eval() : (-VectorXd::Unit(dimension, k)).eval()};
    for (Index i = 0; i < flat.weights.size(); ++i) {
      VectorXd xi(dimension);
      int from = 0;
      for (int d = 0; d < dimension; ++d) {
        const bool free = slanted ? d > 0 : d != k;
        xi[d] = free ? flat.points(i, from++) : 0.0;
      }
      if (slanted) xi[0] = 1.0 - flat.points.row(i).sum();
      face.quadrature.points.row(i) = xi.transpose();
    }
    faces.push_back(std::move(face));
  }
  return faces;
}

LagrangeBasis::LagrangeBasis(const MatrixXd& nodes, int order)
    : nodes_(nodes),
      order_(order),
      exponents_(complete_exponents(static_cast<int>(nodes.cols()), order))
{
  if (static_cast<Index>(exponents_.size()) != nodes.rows()) {
    throw Error(fmt::format("an element of order {} in {} dimensions has {} nodes, not {}", order,
                            nodes.cols(), exponents_.size(), nodes.rows()));
  }
  coefficients_ = products(nodes, exponents_, order, -1).inverse();
}

MatrixXd LagrangeBasis::values(const MatrixXd& points) const
{
  return products(points, exponents_, order_, -1) * coefficients_;
}

MatrixXd LagrangeBasis::derivatives(const MatrixXd& points, int k) const
{
  return products(points, exponents_, order_, k) * coefficients_;
}

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
