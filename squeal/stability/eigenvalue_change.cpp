#include "squeal/stability/eigenvalue_change.hpp"

#include <utility>

#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

struct Pair {
  Complex lambda;
  Eigen::VectorXcd vector;
};

Pair nearest_pair(const Eigen::MatrixXd& A, const Complex& expected)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  Eigen::Index at = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&at);
  return {solver.eigenvalues()[at], solver.eigenvectors().col(at)};
}

}  // namespace

EigenvalueChange::EigenvalueChange(const Eigen::MatrixXd& A, const Complex& expected)
{
  Pair right = nearest_pair(A, expected);
  lambda_ = right.lambda;
  right_ = std::move(right.vector);
  left_ = nearest_pair(A.transpose(), lambda_).vector;
  left_ /= left_.cwiseProduct(right_).sum();
}

}  // namespace chladni::squeal
