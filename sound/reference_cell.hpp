#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::sound {

/// Integration points in a reference cell, one row each, with their weights.
struct Quadrature {
  Eigen::MatrixXd points;  ///< [n x dimension]
  Eigen::VectorXd weights;
};

/// n Gauss-Legendre points on (0, 1), exact to degree 2 n - 1.
Quadrature gauss_points(int n);

/// Points on the unit line, triangle or tetrahedron from collapsed Gauss points, exact to `degree`.
Quadrature simplex_points(int dimension, int degree);

/// A face of the unit simplex: face k < dimension has xi_k = 0, the last one has sum(xi) = 1.
struct ReferenceFace {
  Quadrature quadrature;   ///< points of the cell on this face; weights include its reference area
  Eigen::VectorXd normal;  ///< outward normal, scaled so that normal * weight is the vector area
};

/// The `dimension` + 1 faces of the unit simplex with points exact to `degree`.
std::vector<ReferenceFace> reference_faces(int dimension, int degree);

/// Lagrange basis of complete polynomials on the unit triangle or tetrahedron.
class LagrangeBasis {
 public:
  /// Builds the basis of an order.
  /// @param nodes  [n x dimension] nodes, each with the value one of its own function; n = dim
  ///         P_order
  /// @throws chladni::Error when the number of nodes does not fit the order.
  LagrangeBasis(const Eigen::MatrixXd& nodes, int order);

  int dimension() const { return static_cast<int>(nodes_.cols()); }
  int order() const { return order_; }
  const Eigen::MatrixXd& nodes() const { return nodes_; }

  /// Values of the functions, [n_points x n], at points [n_points x dimension].
  Eigen::MatrixXd values(const Eigen::MatrixXd& points) const;
  /// Derivatives of the functions along xi_k, [n_points x n].
  Eigen::MatrixXd derivatives(const Eigen::MatrixXd& points, int k) const;

 private:
  Eigen::MatrixXd nodes_;
  int order_;
  std::vector<std::vector<int>> exponents_;  ///< degrees of the products of Legendre polynomials
  Eigen::MatrixXd coefficients_;
};

}  // namespace chladni::sound
