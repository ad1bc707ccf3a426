#pragma once

#include <Eigen/Core>
#include <complex>

#include "sound/reference_cell.hpp"

namespace chladni::sound {

/// Integrates the weak form of the Helmholtz equation over one element after the other:
/// integral of grad p . grad q - k^2 p q, in the meridian plane times r and with + n^2 / r^2 p q.
class ElementIntegral {
 public:
  /// @param n  circumferential harmonic in the meridian plane
  ElementIntegral(const LagrangeBasis& basis, double k, int n);

  /// [n x n] symmetric, not Hermitian.
  /// @param x       [n x dimension] real positions of the nodes, which tell the orientation: the
  ///                sign of a complex determinant flips inside a strong layer
  /// @param stretched  their complex positions
  Eigen::MatrixXcd operator()(const Eigen::MatrixXd& x, const Eigen::MatrixXcd& stretched) const;
  /// The same without a layer.
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
  Eigen::MatrixXd N_;   ///< [n_points x n]
  Eigen::MatrixXd dN_;  ///< [dimension n_points x n]: all derivatives of each point in turn
};

}  // namespace chladni::sound
