#pragma once

#include <Eigen/Core>

#include <complex>
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

/// Element matrix of the weak form of the Helmholtz equation: integral of grad p . grad q - k^2 p
/// q, in the meridian plane multiplied by r and with + n^2 / r^2 p q.
class ElementIntegral {
 public:
  /// @param k  wave number, 1/m
  /// @param n  circumferential harmonic in the meridian plane
  ElementIntegral(const LagrangeBasis& basis, double k, int n);

  /// Element matrix inside an absorbing layer.
  /// @param x          [n x dimension] real positions of the nodes, which give the orientation: the
  ///         sign of a complex determinant changes inside a strong layer
  /// @param stretched  [n x dimension] complex positions of the nodes
  /// @return [n x n] symmetric, not Hermitian
  Eigen::MatrixXcd operator()(const Eigen::MatrixXd& x, const Eigen::MatrixXcd& stretched) const;
  /// Element matrix without a layer.
  /// @param x  [n x dimension] positions of the nodes
  /// @return [n x n] symmetric
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& x) const;

 private:
  template <class Scalar>
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  template <class Scalar>
  Matrix<Scalar> integral(const Eigen::MatrixXd& x, const Matrix<Scalar>& stretched) const;

  int dimension_;
  double k_;
  int n_;
  Eigen::VectorXd weights_;
  Eigen::MatrixXd N_;   ///< [n_points x n] shape functions
  Eigen::MatrixXd dN_;  ///< [dimension n_points x n] derivatives, those of each point together
};

}  // namespace chladni::sound
