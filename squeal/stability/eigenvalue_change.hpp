#pragma once

#include <Eigen/Core>
#include <complex>

namespace chladni::squeal {

/// How an eigenvalue of A moves with A, by its left and right eigenvectors: d lambda = l^T dA r
/// with l^T r = 1. True of simple eigenvalues; where two meet, l^T r = 0 before it is made 1, and
/// the derivative is infinite.
class EigenvalueChange {
 public:
  /// Of the eigenvalue nearest to `expected`.
  EigenvalueChange(const Eigen::MatrixXd& A, const std::complex<double>& expected);

  std::complex<double> lambda() const { return lambda_; }

  /// |l| |r| / |l^T r|: 1 for normal matrices, infinite where eigenvalues meet.
  double condition() const { return left_.norm() * right_.norm(); }

  /// d lambda, in the unit of `dA`
  std::complex<double> of(const Eigen::MatrixXd& dA) const
  {
    return left_.cwiseProduct(dA * right_).sum();
  }

 private:
  std::complex<double> lambda_;
  Eigen::VectorXcd right_, left_;
};

}  // namespace chladni::squeal
