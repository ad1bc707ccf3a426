#pragma once

#include <Eigen/Core>

#include "mesh/mesh.hpp"

namespace chladni::plate {

/// Points of the parent element with weights: (xi, eta) in [-1, 1]^2 for a quadrilateral, (r, s)
/// with r, s >= 0, r + s <= 1 for a triangle.
struct Points {
  Eigen::VectorXd xi, eta, weight;
  Eigen::Index size() const { return xi.size(); }
};

/// Values and parent derivatives of all shape functions, [n_points x n_nodes].
struct Basis {
  Eigen::MatrixXd N, N_xi, N_eta;
};

/// Points and weights of a Gauss rule on [-1, 1].
struct GaussRule {
  Eigen::VectorXd x, w;
};
/// The Gauss-Legendre rule with n points, ascending; exact to degree 2 n - 1.
/// Source: Golub and Welsch, Math. Comp. 23 (1969) 221.
GaussRule gauss_legendre(int n);

/// The n >= 2 Gauss-Lobatto points on [-1, 1], ascending, ends included.
Eigen::VectorXd gauss_lobatto(int n);

/// Values of the Lagrange polynomials of `nodes` at `x`, [n_x x n_nodes].
Eigen::MatrixXd lagrange(const Eigen::VectorXd& nodes, const Eigen::VectorXd& x);

/// Derivatives of the Lagrange polynomials of `nodes` at `x`, [n_x x n_nodes].
Eigen::MatrixXd lagrange_derivatives(const Eigen::VectorXd& nodes, const Eigen::VectorXd& x);

/// Tensor product of two sets of coordinates, xi fastest; weights 1.
Points tensor_points(const Eigen::VectorXd& xi, const Eigen::VectorXd& eta);

/// Gauss n x n on a quadrilateral, exact to degree 2 n - 1 in each coordinate; collapsed Gauss n x
/// n on a triangle, exact to degree 2 n - 2.
Points gauss_points(mesh::Shape shape, int n);

/// The complete Lagrange basis of the equidistant lattice of mesh::ElementBlock at some points.
Basis lagrange_basis(mesh::Shape shape, int order, const Points& points);

/// Monomials r^i s^j with i + j <= degree, [n_points x (degree+1)(degree+2)/2].
Eigen::MatrixXd monomials(int degree, const Points& points);

}  // namespace chladni::plate
