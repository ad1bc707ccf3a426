#include "linear/dense/eigenmodes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/deflated_factor.hpp"

namespace chladni::linear {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// L^-1 M L^-T without the directions L^T R of the zero-energy vectors.
struct Deflated {
  MatrixXd A;
  double size;  ///< of what it was before, which round-off in A is relative to
};

Deflated deflated(const MatrixXd& L, const MatrixXd& M, const MatrixXd& R)
{
  const auto lower = L.triangularView<Eigen::Lower>();
  const MatrixXd half = lower.solve(M);
  MatrixXd A = lower.solve(half.transpose());
  const double size = A.diagonal().cwiseAbs().maxCoeff();
  if (R.cols() > 0) {
    const MatrixXd LtR = L.transpose() * R;
    const MatrixXd Y_r = Eigen::LLT<MatrixXd>(MatrixXd(LtR.transpose() * LtR))
                             .matrixL()
                             .solve(LtR.transpose())
                             .transpose();
    A -= Y_r * (Y_r.transpose() * A);
    A -= (A * Y_r) * Y_r.transpose();
  }
  return {0.5 * (A + A.transpose()), size};
}

/// X made M-orthonormal and M-orthogonal to R, low modes first: round-off leaves a high mode with a
/// share eps lambda_max / lambda_min of low ones.
MatrixXd orthonormalized(const MatrixXd& X, const MatrixXd& M, const MatrixXd& R)
{
  const MatrixXd X_0 = X - R * (R.transpose() * M * X);
  const Eigen::LLT<MatrixXd> MX(MatrixXd(X_0.transpose() * M * X_0));
  return MX.matrixL().solve(X_0.transpose()).transpose();
}

/// The modes X, x^T M x = 1, without those of more than a thousand times the first frequency whose
/// mass is round-off of its parts |x|^T |M| |x|: the rotation of a shell about its normal, of which
/// the mass is what the other modes leave of it.
std::vector<Index> with_mass(const MatrixXd& X, const MatrixXd& M, const VectorXd& mu,
                             double largest_rounding)
{
  constexpr double far = 1e-6;
  const VectorXd parts =
      (X.cwiseAbs().array() * (M.cwiseAbs() * X.cwiseAbs()).array()).colwise().sum();
  std::vector<Index> massive;
  for (Index j = 0; j < X.cols(); ++j) {
    const bool is_round_off = std::numeric_limits<double>::epsilon() * parts[j] > largest_rounding;
    if (!is_round_off || mu[j] > far * mu[0]) massive.push_back(j);
  }
  return massive;
}

}  // namespace

Eigenmodes eigenmodes(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R,
                      double orthonormal_to)
{
  const Index n = K.rows(), r = R.cols();
  if (n <= r) return {VectorXd(0), MatrixXd(n, 0), 0};
  const Eigen::LLT<MatrixXd> B = deflated_factor(K, M, R);
  const MatrixXd L = B.matrixL();
  const auto [A, size] = deflated(L, M, R);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  const VectorXd mu = solver.eigenvalues().reverse();
  const double round_off =
      4.0 * static_cast<double>(n) * std::numeric_limits<double>::epsilon() * std::max(mu[0], size);
  if (mu[n - 1] < -round_off)
    throw Error("eigenmodes: the mass matrix is not positive semidefinite");
  const Index k = std::min<Index>(n - r, (mu.array() > round_off).count());
  const MatrixXd Y = solver.eigenvectors().rowwise().reverse().leftCols(k);
  MatrixXd X = L.transpose().triangularView<Eigen::Upper>().solve(Y);
  X.array().rowwise() /= mu.head(k).array().sqrt().transpose();
  const std::vector<Index> massive = with_mass(X, M, mu, orthonormal_to);
  const VectorXd lambda = mu(massive).cwiseInverse();
  return {lambda, orthonormalized(X(every, massive), M, R),
          static_cast<int>(n - r - lambda.size())};
}

double first_eigenvalue(const MatrixXd& K, const MatrixXd& M, const MatrixXd& R)
{
  if (K.rows() <= R.cols()) return 0.0;
  const Eigen::LLT<MatrixXd> B = deflated_factor(K, M, R);
  constexpr int n_iterations = 30;
  // All coordinates take part, none in a pattern that a mode may have too.
  VectorXd x = VectorXd::NullaryExpr(
      K.rows(), [](Index i) { return std::cos(1.0 + static_cast<double>(i) * std::sqrt(2.0)); });
  double largest = 0.0;  // 1 / lambda, by the quotient of Rayleigh
  for (int i = 0; i < n_iterations; ++i) {
    x -= R * (R.transpose() * (M * x));
    const VectorXd Mx = M * x;
    const double mass = x.dot(Mx);
    if (!(mass > 0.0)) return 0.0;
    x = B.solve(Mx);
    largest = x.dot(Mx) / mass;
    x.normalize();
  }
  return largest > 0.0 ? 1.0 / largest : 0.0;
}

}  // namespace chladni::linear
