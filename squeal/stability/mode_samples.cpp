#include "squeal/stability/mode_samples.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/eigen_every.hpp"
#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/parallel.hpp"
#include "squeal/stability/stability_samples.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;

/// Condition of an eigenvalue beyond which it is no longer asked for; see stability_samples.cpp.
constexpr double most_condition = 1e6;
/// MAC from which two shapes are one motion without further doubt.
constexpr double sure_likeness = 0.5;
/// How much farther than the chosen eigenvalue all others are, for it to be alone.
constexpr double alone = 4.0;
/// Halvings of the distance of two samples, where shapes change fast.
constexpr int halvings_max = 4;
/// Deviation from the extrapolation, relative to lambda, that says little about two motions.
constexpr double small_deviation = 1e-3;

/// The places of one eigenvalue of each mode, as oscillating_eigenvalues chooses and orders them.
std::vector<Index> oscillating(const Eigen::VectorXcd& lambda)
{
  std::vector<Index> at(static_cast<std::size_t>(lambda.size()));
  std::iota(at.begin(), at.end(), Index{0});
  std::ranges::sort(at, [&](Index i, Index j) {
    return lambda[i].imag() != lambda[j].imag() ? lambda[i].imag() > lambda[j].imag()
                                                : lambda[i].real() > lambda[j].real();
  });
  at.resize(at.size() / 2);
  return at;
}

ModeSample in_order(const ModeSample& sample, const std::vector<Index>& order)
{
  return {sample.value, sample.lambda(order), sample.X(every, order), sample.Y(every, order),
          sample.doubt(order)};
}

/// The motions of a sample in the order of another one.
struct Matching {
  ModeSample sample;
  bool sure;  ///< that each motion has been told from the others
};

/// The pairs that are most alike, by both shape and eigenvalue, are found first.
Matching matching(const ModeSample& before, const Eigen::VectorXcd& expected, const ModeSample& now)
{
  const Index n = now.size();
  const Eigen::MatrixXd likeness =
      (before.X.adjoint() * now.X).cwiseAbs().cwiseProduct((before.Y.adjoint() * now.Y).cwiseAbs());
  Eigen::MatrixXd distance(n, n), cost(n, n);
  for (Index i = 0; i < n; ++i) {
    distance.row(i) = (now.lambda.array() - expected[i]).abs().transpose();
    const double usual =
        std::abs(expected[i] - before.lambda[i]) + small_deviation * std::abs(expected[i]);
    cost.row(i) = 1.0 - likeness.row(i).array() +
                  distance.row(i).array() / (distance.row(i).array() + usual + 1e-300);
  }
  std::vector<Index> order(static_cast<std::size_t>(n));
  bool sure = true;
  for (Index k = 0; k < n; ++k) {
    Index i = 0, j = 0;
    cost.minCoeff(&i, &j);
    order[static_cast<std::size_t>(i)] = j;
    const bool is_alone = (distance.row(i).array() <= alone * distance(i, j)).count() == 1;
    sure = sure && (likeness(i, j) >= sure_likeness || is_alone);
    cost.row(i).setConstant(std::numeric_limits<double>::infinity());
    cost.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return {in_order(now, order), sure};
}

/// A motion as it was last seen, and how fast its eigenvalues change with the parameter.
struct Last {
  const ModeSample& sample;
  Eigen::VectorXcd slope;

  Eigen::VectorXcd expected(double value) const
  {
    return sample.lambda + slope * (value - sample.value);
  }
};

Eigen::VectorXcd slope_of(const ModeSample& low, const ModeSample& high)
{
  return (high.lambda - low.lambda) / (high.value - low.value);
}

/// `now` in the order of the last sample, through values between them where need be.
ModeSample continued(const StateMatrixOf& A, const Last& last, const ModeSample& now, int halvings)
{
  Matching match = matching(last.sample, last.expected(now.value), now);
  if (match.sure || halvings == 0) return std::move(match.sample);
  const ModeSample middle =
      continued(A, last, mode_sample(A, std::midpoint(last.sample.value, now.value)), halvings - 1);
  return continued(A, {middle, slope_of(last.sample, middle)}, now, halvings - 1);
}

}  // namespace

StabilityPoint ModeSample::point(Index j) const
{
  return {value, growth(j), std::abs(lambda[j].imag()) / (2.0 * std::numbers::pi)};
}

ModeSample mode_sample(const StateMatrixOf& A, double value)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A(value));
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Eigen::MatrixXcd X = solver.eigenvectors().colwise().normalized();
  const Eigen::MatrixXcd Y = X.inverse().adjoint();
  const std::vector<Index> at = oscillating(solver.eigenvalues());
  ModeSample sample{value, solver.eigenvalues()(at), X(every, at), Y(every, at), {}};
  sample.doubt.resize(sample.size());
  const double zero = rounding_of(solver.eigenvalues());
  for (Index j = 0; j < sample.size(); ++j) {
    const double condition = sample.Y.col(j).norm();
    const bool known = std::isfinite(condition) && condition < most_condition;
    sample.doubt[j] = zero * (known ? condition : most_condition);
    // Two eigenvectors that are the same to the last digit have no left ones.
    if (std::isfinite(condition))
      sample.Y.col(j) /= condition;
    else
      sample.Y.col(j).setZero();
  }
  return sample;
}

std::vector<ModeSample> followed_modes(const StateMatrixOf& A, const SearchRange& range)
{
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(range.count, range.from, range.to);
  std::vector<ModeSample> samples(static_cast<std::size_t>(range.count));
  for_each_index(range.count,
                 [&](int i) { samples[static_cast<std::size_t>(i)] = mode_sample(A, values[i]); });
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const ModeSample& last = samples[i - 1];
    const Eigen::VectorXcd slope = i > 1 ? slope_of(samples[i - 2], last)
                                         : Eigen::VectorXcd(Eigen::VectorXcd::Zero(last.size()));
    samples[i] = continued(A, {last, slope}, samples[i], halvings_max);
  }
  return samples;
}

ModeSample mode_sample_between(const StateMatrixOf& A, const ModeSample& low,
                               const ModeSample& high, double t)
{
  const ModeSample& near = t <= 0.5 ? low : high;
  const double value = low.value + t * (high.value - low.value);
  return continued(A, {near, slope_of(low, high)}, mode_sample(A, value), 1);
}

}  // namespace chladni::squeal
