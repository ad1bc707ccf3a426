#include "squeal/stability/stability_samples.hpp"

#include <cmath>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalue_branches.hpp"

namespace chladni::squeal {
namespace {

/// Growth that rounding can make of a neutral motion whose eigenvalue has the condition 1, relative
/// to the largest eigenvalue.
constexpr double rounding = 1e-12;
/// Growth, relative to the largest eigenvalue, beyond which no condition is asked for: rounding
/// makes so much only of eigenvalues that coincide to twelve digits.
constexpr double beyond_doubt = 1e-6;

/// Condition of each eigenvalue, 1 / |y^H x| of its left and right eigenvectors of norm 1.
Eigen::VectorXd conditions(const Eigen::MatrixXcd& X)
{
  const Eigen::MatrixXcd Y = X.inverse();
  return Y.rowwise().norm().cwiseProduct(X.colwise().norm().transpose());
}

bool grows(const Eigen::MatrixXd& A, const Eigen::VectorXcd& lambda)
{
  const double growth = lambda.real().maxCoeff(), zero = rounding_of(lambda);
  if (growth <= zero) return false;
  if (growth > zero * (beyond_doubt / rounding)) return true;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Eigen::VectorXd kappa = conditions(solver.eigenvectors());
  for (Eigen::Index i = 0; i < kappa.size(); ++i) {
    // Two eigenvectors that are the same to the last digit have no finite condition.
    const double doubt = std::isfinite(kappa[i]) ? kappa[i] : beyond_doubt / rounding;
    if (solver.eigenvalues()[i].real() > zero * doubt) return true;
  }
  return false;
}

StabilitySample sample_at(const StateMatrixOf& A, double value, const Eigen::VectorXcd& expected)
{
  const Eigen::MatrixXd A_here = A(value);
  const Eigen::VectorXcd lambda = oscillating_eigenvalues(A_here);
  return {value, expected.size() > 0 ? matched(lambda, expected) : lambda, grows(A_here, lambda)};
}

/// @param is_enough  of the samples so far
std::vector<StabilitySample> scan_until(const StateMatrixOf& A, const SearchRange& range,
                                        const auto& is_enough)
{
  std::vector<StabilitySample> samples;
  for (const double value : Eigen::VectorXd::LinSpaced(range.count, range.from, range.to)) {
    Eigen::VectorXcd expected;
    if (!samples.empty()) expected = samples.back().lambda;
    if (samples.size() > 1) expected += samples.back().lambda - samples.end()[-2].lambda;
    samples.push_back(sample_at(A, value, expected));
    if (is_enough(samples)) break;
  }
  return samples;
}

}  // namespace

bool is_unstable(const Eigen::MatrixXd& A)
{
  return grows(A, oscillating_eigenvalues(A));
}

double rounding_of(const Eigen::VectorXcd& lambda)
{
  return rounding * lambda.cwiseAbs().maxCoeff();
}

std::vector<StabilitySample> scan(const StateMatrixOf& A, const SearchRange& range)
{
  return scan_until(A, range, [](const auto& /*samples*/) { return false; });
}

std::vector<StabilitySample> scan_until_loss(const StateMatrixOf& A, const SearchRange& range)
{
  return scan_until(A, range, [](const std::vector<StabilitySample>& samples) {
    return samples.size() > 1 && samples.back().unstable && !samples.end()[-2].unstable;
  });
}

StabilitySample sample_between(const StateMatrixOf& A, const StabilitySample& low,
                               const StabilitySample& high, double t)
{
  return sample_at(A, low.value + t * (high.value - low.value),
                   (1.0 - t) * low.lambda + t * high.lambda);
}

}  // namespace chladni::squeal
