#pragma once

#include <Eigen/Core>
#include <complex>

namespace chladni::squeal {

/// First-order change of an eigenvalue of A by its left and right eigenvectors, d lambda = l^T dA r
/// with l^T r = 1. It holds for simple eigenvalues; where two coincide, l^T r = 0 before scaling,
/// and the derivative is infinite.
class EigenvalueChange {
 public:
  /// The change of the eigenvalue nearest to `expected`.
  EigenvalueChange(const Eigen::MatrixXd& A, const std::complex<double>& expected);

  std::complex<double> lambda() const { return lambda_; }

  /// Condition number |l| |r| / |l^T r| of the eigenvalue: 1 for normal matrices, infinite where
  /// eigenvalues coincide.
  double condition() const { return left_.norm() * right_.norm(); }

  /// d lambda for a change dA of the matrix, in the unit of `dA`.
  std::complex<double> of(const Eigen::MatrixXd& dA) const
  {
    return left_.cwiseProduct(dA * right_).sum();
  }

 private:
  std::complex<double> lambda_;
  Eigen::VectorXcd right_, left_;
};

}  // namespace chladni::squeal
