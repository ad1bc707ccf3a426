#pragma once

#include <Eigen/Core>
#include <complex>

#include "sound/reference_cell.hpp"

namespace chladni::sound {

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
