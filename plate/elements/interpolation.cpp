#include "plate/elements/interpolation.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace chladni::plate {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Eigenvalues of a symmetric tridiagonal matrix with zero diagonal are the nodes of a rule whose
/// orthogonal polynomials have these recurrence coefficients.
Eigen::SelfAdjointEigenSolver<MatrixXd> jacobi_matrix(const VectorXd& off_diagonal)
{
  const Eigen::Index n = off_diagonal.size() + 1;
  MatrixXd J = MatrixXd::Zero(n, n);
  J.diagonal(1) = off_diagonal;
  J.diagonal(-1) = off_diagonal;
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(J);
}

/// Row by row Kronecker product: nodes xi fastest, as the lattice order.
MatrixXd row_products(const MatrixXd& along_xi, const MatrixXd& along_eta)
{
  MatrixXd product(along_xi.rows(), along_xi.cols() * along_eta.cols());
  for (Eigen::Index q = 0; q < product.rows(); ++q) {
    for (Eigen::Index j = 0; j < along_eta.cols(); ++j) {
      product.row(q).segment(j * along_xi.cols(), along_xi.cols()) =
          along_eta(q, j) * along_xi.row(q);
    }
  }
  return product;
}

Basis quadrilateral_basis(int order, const Points& points)
{
  const VectorXd nodes = VectorXd::LinSpaced(order + 1, -1.0, 1.0);
  const MatrixXd L_xi = lagrange(nodes, points.xi);
  const MatrixXd L_eta = lagrange(nodes, points.eta);
  return {.N = row_products(L_xi, L_eta),
          .N_xi = row_products(lagrange_derivatives(nodes, points.xi), L_eta),
          .N_eta = row_products(L_xi, lagrange_derivatives(nodes, points.eta))};
}

Points triangle_lattice(int order)
{
  const int n = (order + 1) * (order + 2) / 2;
  Points lattice{.xi = VectorXd(n), .eta = VectorXd(n), .weight = VectorXd::Ones(n)};
  int k = 0;
  for (int j = 0; j <= order; ++j) {
    for (int i = 0; i <= order - j; ++i, ++k) {
      lattice.xi[k] = double(i) / order;
      lattice.eta[k] = double(j) / order;
    }
  }
  return lattice;
}

struct MonomialDerivatives {
  MatrixXd by_r, by_s;
};

MonomialDerivatives monomial_derivatives(int degree, const Points& points)
{
  const int n = (degree + 1) * (degree + 2) / 2;
  MonomialDerivatives d{.by_r = MatrixXd(points.size(), n), .by_s = MatrixXd(points.size(), n)};
  int k = 0;
  for (int total = 0; total <= degree; ++total) {
    for (int j = 0; j <= total; ++j, ++k) {
      const int i = total - j;
      for (Eigen::Index q = 0; q < points.size(); ++q) {
        const double r = points.xi[q];
        const double s = points.eta[q];
        d.by_r(q, k) = i == 0 ? 0.0 : i * std::pow(r, i - 1) * std::pow(s, j);
        d.by_s(q, k) = j == 0 ? 0.0 : j * std::pow(r, i) * std::pow(s, j - 1);
      }
    }
  }
  return d;
}

Basis triangle_basis(int order, const Points& points)
{
  const MatrixXd inverse = monomials(order, triangle_lattice(order)).inverse();
  const MonomialDerivatives d = monomial_derivatives(order, points);
  return {
      .N = monomials(order, points) * inverse, .N_xi = d.by_r * inverse, .N_eta = d.by_s * inverse};
}

Points collapsed_gauss(int n)
{
  const GaussRule g = gauss_legendre(n);
  Points points{.xi = VectorXd(n * n), .eta = VectorXd(n * n), .weight = VectorXd(n * n)};
  for (int j = 0, k = 0; j < n; ++j) {
    const double s = 0.5 * (1.0 + g.x[j]);
    for (int i = 0; i < n; ++i, ++k) {
      points.xi[k] = 0.5 * (1.0 + g.x[i]) * (1.0 - s);
      points.eta[k] = s;
      points.weight[k] = 0.25 * g.w[i] * g.w[j] * (1.0 - s);
    }
  }
  return points;
}

}  // namespace

GaussRule gauss_legendre(int n)
{
  VectorXd off_diagonal(n - 1);
  for (int k = 1; k < n; ++k) off_diagonal[k - 1] = k / std::sqrt(4.0 * k * k - 1.0);
  const auto eigen = jacobi_matrix(off_diagonal);
  return {.x = eigen.eigenvalues(), .w = 2.0 * eigen.eigenvectors().row(0).array().square()};
}

VectorXd gauss_lobatto(int n)
{
  VectorXd x(n);
  x[0] = -1.0;
  x[n - 1] = 1.0;
  if (n == 2) return x;
  // The inner points are the zeros of P'_(n-1), a Jacobi polynomial with alpha = beta = 1.
  VectorXd off_diagonal(n - 3);
  for (int k = 1; k < n - 2; ++k)
    off_diagonal[k - 1] = std::sqrt(k * (k + 2.0) / ((2.0 * k + 1.0) * (2.0 * k + 3.0)));
  x.segment(1, n - 2) = jacobi_matrix(off_diagonal).eigenvalues();
  return x;
}

MatrixXd lagrange(const VectorXd& nodes, const VectorXd& x)
{
  MatrixXd L = MatrixXd::Ones(x.size(), nodes.size());
  for (Eigen::Index i = 0; i < nodes.size(); ++i) {
    for (Eigen::Index k = 0; k < nodes.size(); ++k)
      if (k != i) L.col(i).array() *= (x.array() - nodes[k]) / (nodes[i] - nodes[k]);
  }
  return L;
}

MatrixXd lagrange_derivatives(const VectorXd& nodes, const VectorXd& x)
{
  const Eigen::Index n = nodes.size();
  MatrixXd dL = MatrixXd::Zero(x.size(), n);
  for (Eigen::Index q = 0; q < x.size(); ++q) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = 0; k < n; ++k) {
        if (k == i) continue;
        double term = 1.0 / (nodes[i] - nodes[k]);
        for (Eigen::Index j = 0; j < n; ++j)
          if (j != i && j != k) term *= (x[q] - nodes[j]) / (nodes[i] - nodes[j]);
        dL(q, i) += term;
      }
    }
  }
  return dL;
}

Points tensor_points(const VectorXd& xi, const VectorXd& eta)
{
  const Eigen::Index n = xi.size() * eta.size();
  Points points{.xi = VectorXd(n), .eta = VectorXd(n), .weight = VectorXd::Ones(n)};
  for (Eigen::Index j = 0; j < eta.size(); ++j) {
    points.xi.segment(j * xi.size(), xi.size()) = xi;
    points.eta.segment(j * xi.size(), xi.size()).setConstant(eta[j]);
  }
  return points;
}

Points gauss_points(mesh::Shape shape, int n)
{
  if (shape == mesh::Shape::triangle) return collapsed_gauss(n);
  const GaussRule g = gauss_legendre(n);
  Points points = tensor_points(g.x, g.x);
  points.weight = (g.w * g.w.transpose()).reshaped();
  return points;
}

Basis lagrange_basis(mesh::Shape shape, int order, const Points& points)
{
  return shape == mesh::Shape::triangle ? triangle_basis(order, points)
                                        : quadrilateral_basis(order, points);
}

MatrixXd monomials(int degree, const Points& points)
{
  MatrixXd V(points.size(), (degree + 1) * (degree + 2) / 2);
  int k = 0;
  for (int total = 0; total <= degree; ++total)
    for (int j = 0; j <= total; ++j, ++k)
      V.col(k) = points.xi.array().pow(total - j) * points.eta.array().pow(j);
  return V;
}

}  // namespace chladni::plate
