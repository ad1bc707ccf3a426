#include "squeal/stability/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalue_branches.hpp"
#include "squeal/stability/stability_search.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;

Eigen::VectorXd speeds_of(const SpeedRange& range, int count)
{
  return Eigen::VectorXd::LinSpaced(count, range.from, range.to);
}

SearchRange search_over(const SpeedRange& speeds)
{
  return {.from = speeds.from, .to = speeds.to, .count = std::max(128, speeds.count)};
}

}  // namespace

Complex least_stable_eigenvalue(const Eigen::MatrixXd& A)
{
  const Eigen::VectorXcd lambda = oscillating_eigenvalues(A);
  Eigen::Index worst = 0;
  lambda.real().maxCoeff(&worst);
  return lambda[worst];
}

EigenPair least_stable_pair(const Eigen::MatrixXd& A)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Complex expected = least_stable_eigenvalue(A);
  Eigen::Index i = 0;
  (solver.eigenvalues().array() - expected).abs().minCoeff(&i);
  return {solver.eigenvalues()[i], solver.eigenvectors().col(i).normalized()};
}

EigenvalueMap eigenvalues(const StateMatrixAt& A, const SpeedRange& range)
{
  const Eigen::VectorXd speeds = speeds_of(range, range.count);
  Eigen::MatrixXcd lambda;
  for (Eigen::Index i = 0; i < speeds.size(); ++i) {
    const Eigen::VectorXcd now = oscillating_eigenvalues(A(speeds[i]));
    if (i == 0) {
      lambda.resize(speeds.size(), now.size());
      lambda.row(i) = now.reverse().transpose();
      continue;
    }
    const Eigen::VectorXcd before = lambda.row(std::max<Eigen::Index>(i - 2, 0)).transpose();
    const Eigen::VectorXcd last = lambda.row(i - 1).transpose();
    lambda.row(i) = matched(now, 2.0 * last - before).transpose();
  }
  return {speeds, lambda};
}

StabilityProfile stability_over_speed(const StateMatrixAt& A, const SpeedRange& range)
{
  return stability_over(A, search_over(range));
}

StabilityProfile stability_until_critical(const StateMatrixAt& A, const SpeedRange& range)
{
  return stability_until_loss(A, search_over(range));
}

std::optional<CriticalSpeed> critical_speed(const StabilityProfile& profile)
{
  const std::optional<StabilityPoint> lost = first_loss(profile);
  if (!lost) return std::nullopt;
  return CriticalSpeed{lost->value, lost->frequency_Hz, lost->n_newton_steps};
}

}  // namespace chladni::squeal
