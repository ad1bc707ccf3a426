#pragma once

#include <Eigen/Core>
#include <vector>

namespace chladni::sound {

/// Points xi in a reference cell, one row each, with their weights.
struct Quadrature {
  Eigen::MatrixXd points;  ///< [n x dimension]
  Eigen::VectorXd weights;
};

/// Gauss-Legendre points on (0, 1), exact to degree 2 n - 1.
Quadrature gauss_points(int n);

/// Points of the unit line, triangle or tetrahedron by collapsed Gauss points, exact to `degree`.
Quadrature simplex_points(int dimension, int degree);

/// One face of a unit simplex: face k < dimension is xi_k = 0, the last one sum(xi) = 1.
struct ReferenceFace {
  Quadrature quadrature;   ///< points of the cell on this face; weights with its reference measure
  Eigen::VectorXd normal;  ///< outward, scaled such that normal * weight is the vectorial area
};

/// The `dimension` + 1 faces with points exact to `degree`.
std::vector<ReferenceFace> reference_faces(int dimension, int degree);

/// Lagrange polynomials of complete degree on the unit triangle or tetrahedron.
class LagrangeBasis {
 public:
  /// @param nodes  [n x dimension] where the functions are one in turn; n = dim P_order
  /// @throws chladni::Error when their number does not fit the order.
  LagrangeBasis(const Eigen::MatrixXd& nodes, int order);

  int dimension() const { return static_cast<int>(nodes_.cols()); }
  int order() const { return order_; }
  const Eigen::MatrixXd& nodes() const { return nodes_; }

  /// [n_points x n] at points [n_points x dimension]
  Eigen::MatrixXd values(const Eigen::MatrixXd& points) const;
  /// [n_points x n] derivatives along xi_k
  Eigen::MatrixXd derivatives(const Eigen::MatrixXd& points, int k) const;

 private:
  Eigen::MatrixXd nodes_;
  int order_;
  std::vector<std::vector<int>> exponents_;  ///< of the products of Legendre polynomials
  Eigen::MatrixXd coefficients_;
};

}  // namespace chladni::sound
