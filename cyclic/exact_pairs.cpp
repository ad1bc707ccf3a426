#include "cyclic/exact_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace chladni::cyclic {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// The end of the modes whose frequency is that of mode `first` to round-off.
Index end_of_cluster(const VectorXd& omega, Index first)
{
  constexpr double close = 1e-6;  // relative; eigenvalues are found to 1e-12 and better
  Index end = first + 1;
  while (end < omega.size() && omega[end] - omega[end - 1] < close * omega[end]) ++end;
  return end;
}

/// v without its parts along the first columns of Q, twice for round-off.
VectorXd orthogonalised(VectorXd v, const MatrixXd& Q, Index n)
{
  for (int pass = 0; pass < 2; ++pass) v -= Q.leftCols(n) * (Q.leftCols(n).transpose() * v);
  return v;
}

/// The unit vector that is furthest from the first columns of Q.
VectorXd next_direction(const MatrixXd& Q, Index n)
{
  Index furthest = 0;
  (VectorXd::Ones(Q.rows()) - Q.leftCols(n).rowwise().squaredNorm()).maxCoeff(&furthest);
  return orthogonalised(VectorXd::Unit(Q.rows(), furthest), Q, n).normalized();
}

/// Orthonormal columns v, S v, v', S v', ...
MatrixXd pairs_of_cluster(const MatrixXd& S)
{
  constexpr double closed = 0.99;  // S v is as long as v where the partner is in the cluster
  MatrixXd Q = MatrixXd::Zero(S.rows(), S.rows());
  Index n = 0;
  while (n + 2 <= S.rows()) {
    const VectorXd v = next_direction(Q, n);
    Q.col(n) = v;
    const VectorXd partner = orthogonalised(S * v, Q, n + 1);
    if (!(partner.norm() > closed)) break;
    Q.col(n + 1) = partner.normalized();
    n += 2;
  }
  return Q.leftCols(n);
}

}  // namespace

ExactPairs exact_pairs(const VectorXd& omega, const MatrixXd& S)
{
  const Index n = omega.size();
  ExactPairs pairs{.W = MatrixXd::Zero(n, n), .omega = VectorXd(n)};
  Index n_paired = 0;
  for (Index first = 0; first < n;) {
    const Index end = end_of_cluster(omega, first), width = end - first;
    const MatrixXd Q = pairs_of_cluster(S.block(first, first, width, width));
    pairs.W.block(first, n_paired, width, Q.cols()) = Q;
    for (Index k = 0; k < Q.cols(); k += 2) {
      const VectorXd lambda = omega.segment(first, width).cwiseAbs2();
      const double mean = 0.5 * (Q.middleCols(k, 2).cwiseAbs2().transpose() * lambda).sum();
      pairs.omega.segment<2>(n_paired + k).setConstant(std::sqrt(mean));
    }
    n_paired += Q.cols();
    first = end;
  }
  pairs.W.conservativeResize(n, n_paired);
  pairs.omega.conservativeResize(n_paired);
  return pairs;
}

}  // namespace chladni::cyclic
