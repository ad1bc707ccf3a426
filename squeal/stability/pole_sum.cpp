#include "squeal/stability/pole_sum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "common/eigen_every.hpp"
#include "linear/dense/dense_solvers.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

/// Relative to the norm of A_0: what rounding makes of the entries of state matrices, times 100.
constexpr double rounding = 1e-14;

/// Of the eigenvectors of A_0: it multiplies the rounding errors of all eigenvalues.
constexpr double largest_condition = 1e4;

/// Beyond this rank sums of r x r matrices at n / 2 points take longer than the QR iteration, whose
/// time goes with n^3 and that of the sums with n^2 r^2.
Index largest_rank(Index n)
{
  return static_cast<Index>(2.0 * std::sqrt(double(n)));
}

/// Orthonormal columns that span those of all `changes` up to `tolerance`, the largest first;
/// more than `largest_rank` of them say only that there are too many.
Eigen::MatrixXd common_columns(Eigen::MatrixXd changes, double tolerance)
{
  Eigen::MatrixXd U(changes.rows(), 0);
  while (U.cols() <= largest_rank(U.rows())) {
    Index largest = 0;
    if (changes.colwise().norm().maxCoeff(&largest) <= tolerance) break;
    Eigen::VectorXd u = changes.col(largest).normalized();
    u = (u - U * (U.transpose() * u)).normalized();
    changes -= u * (u.transpose() * changes);
    U.conservativeResize(Eigen::NoChange, U.cols() + 1);
    U.rightCols(1) = u;
  }
  return U;
}

Eigen::MatrixXd changes_of(const Eigen::MatrixXd& A_0, const std::vector<Eigen::MatrixXd>& samples)
{
  const Index n = A_0.rows();
  Eigen::MatrixXd changes(n, n * static_cast<Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    changes.middleCols(n * static_cast<Index>(i), n) = samples[i] - A_0;
  return changes;
}

}  // namespace

std::optional<LowRankChange> LowRankChange::about(const Eigen::MatrixXd& A_0,
                                                  const std::vector<Eigen::MatrixXd>& samples)
{
  const Index n = A_0.rows(), m = n / 2;
  LowRankChange change;
  change.A_0_ = A_0;
  change.rounding_ = rounding * A_0.norm();
  change.U_ = common_columns(changes_of(A_0, samples), change.rounding_);
  if (change.U_.cols() == 0 || change.U_.cols() > largest_rank(n)) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A_0);
  if (solver.info() != Eigen::Success || (solver.eigenvalues().imag().array() == 0.0).any())
    return std::nullopt;
  // Columns (p, q) for each pair p +- i q of right eigenvectors.
  const Eigen::MatrixXd& P = solver.pseudoEigenvectors();
  const Eigen::MatrixXd P_inverse = P.partialPivLu().inverse();
  if (!(P.norm() * P_inverse.norm() <= largest_condition * double(n))) return std::nullopt;
  change.poles_ = solver.eigenvalues()(Eigen::seqN(0, m, 2));
  change.re_ = P(every, Eigen::seqN(0, m, 2));
  change.im_ = P(every, Eigen::seqN(1, m, 2));
  const Eigen::MatrixXd q = P_inverse * change.U_;
  change.left_.resize(m, q.cols());
  change.left_.real() = 0.5 * q(Eigen::seqN(0, m, 2), every);
  change.left_.imag() = -0.5 * q(Eigen::seqN(1, m, 2), every);
  return change;
}

std::optional<PoleSum> LowRankChange::sum_of(const Eigen::MatrixXd& A) const
{
  const Eigen::MatrixXd change = A - A_0_;
  const Eigen::MatrixXd Y = U_.transpose() * change;
  if (!((change - U_ * Y).colwise().norm().maxCoeff() <= rounding_)) return std::nullopt;
  const Index m = poles_.size(), r = U_.cols();
  Eigen::MatrixXcd right(r, m);
  right.real() = Y * re_;
  right.imag() = Y * im_;
  const Eigen::VectorXd by_left = left_.rowwise().norm(), by_right = right.colwise().norm();
  const double left_max = by_left.maxCoeff(), right_max = by_right.maxCoeff();
  PoleSum sum{.modes = {}, .poles = {}, .numerators = Eigen::MatrixXd(2 * r * r, m), .rank = r};
  for (Index k = 0; k < m; ++k) {
    if (std::min(by_left[k] * right_max, by_right[k] * left_max) <= rounding_) continue;
    const auto at = static_cast<Index>(sum.modes.size());
    for (Index j = 0; j < r; ++j)
      for (Index i = 0; i < r; ++i) {
        const Complex R = right(i, k) * left_(k, j);
        sum.numerators(j * r + i, at) = 2.0 * R.real();
        sum.numerators(r * r + j * r + i, at) = -2.0 * (R * std::conj(poles_[k])).real();
      }
    sum.modes.push_back(k);
  }
  sum.numerators.conservativeResize(Eigen::NoChange, static_cast<Index>(sum.modes.size()));
  sum.poles = poles_(sum.modes);
  return sum;
}

}  // namespace chladni::squeal
