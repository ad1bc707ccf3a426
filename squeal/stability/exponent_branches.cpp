#include "squeal/stability/exponent_branches.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "squeal/parallel.hpp"
#include "squeal/root.hpp"
#include "squeal/stability/followed_samples.hpp"

namespace chladni::squeal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

/// Part of its distance that a change of the replica costs.
constexpr double replica_cost = 0.05;
/// Of the distance of two samples, to which a limit between them is found.
constexpr double limit_error = 1e-4;
/// Halvings of the distance of two samples in the search for an extremum.
constexpr int halvings_of_extremum = 6;
/// Of the distance of two values, for the first slopes.
constexpr double first_step = 1e-3;

/// Where the motions are expected.
struct Expected {
  Eigen::VectorXcd lambda;  ///< [n] continuous in the parameter, 1/s
  Eigen::VectorXd turns;    ///< [n] of the sample before
};

Eigen::VectorXcd continuous(const ExponentSample& sample)
{
  return sample.motion.lambda + Complex(0.0, sample.speed) * sample.turns;
}

/// From `a` at t = 0 and `b` at t = 1, with the turns of the nearer one.
Expected expected_at(const ExponentSample& a, const ExponentSample& b, double t)
{
  return {(1.0 - t) * continuous(a) + t * continuous(b), t < 0.5 ? a.turns : b.turns};
}

/// Turns that bring lambda nearest to the expected exponent: multiples of nu.
double turns_to(const ExponentSample& sample, Complex lambda, Complex expected)
{
  const double nu = std::max(1, sample.motion.nu);
  return nu * std::round((expected - lambda).imag() / (nu * sample.speed));
}

/// In the order of the expected exponents: the closest pairs are found first. A motion that does
/// not oscillate may be missing at a value; it is then where it was expected.
ExponentSample ordered(ExponentSample sample, const Expected& expected)
{
  const Eigen::VectorXcd found = sample.motion.lambda;
  const Index n = found.size(), m = expected.lambda.size();
  Eigen::MatrixXd cost(n, m);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < m; ++j) {
      const double turns = turns_to(sample, found[i], expected.lambda[j]);
      cost(i, j) = std::abs(found[i] + Complex(0.0, turns * sample.speed) - expected.lambda[j]) +
                   replica_cost * std::abs(turns - expected.turns[j]) * sample.speed;
    }
  sample.turns = expected.turns;
  sample.motion.lambda = expected.lambda - Complex(0.0, sample.speed) * expected.turns;
  for (Index k = 0; k < std::min(n, m); ++k) {
    Index i = 0, j = 0;
    cost.minCoeff(&i, &j);
    sample.turns[j] = turns_to(sample, found[i], expected.lambda[j]);
    sample.motion.lambda[j] = found[i];
    cost.row(i).setConstant(std::numeric_limits<double>::infinity());
    cost.col(j).setConstant(std::numeric_limits<double>::infinity());
  }
  return sample;
}

ExponentSample sample_between(const ExponentsAt& exponents, const ExponentSample& a,
                              const ExponentSample& b, double t)
{
  return ordered(exponents((1.0 - t) * a.value + t * b.value), expected_at(a, b, t));
}

/// Where motion j begins to grow, or ends to.
StabilityPoint limit_between(const ExponentsAt& exponents, const ExponentSample& a,
                             const ExponentSample& b, Index j)
{
  const ExponentSample& stable = a.is_unstable(j) ? b : a;
  const ExponentSample& unstable = a.is_unstable(j) ? a : b;
  const double zero = stable.growth(j) < 0.0 ? 0.0 : stable.motion.error;
  StabilityPoint last{};
  const auto growth = [&](double value) {
    if (value == stable.value) return stable.growth(j) - zero;
    if (value == unstable.value) return unstable.growth(j) - zero;
    last = sample_between(exponents, a, b, (value - a.value) / (b.value - a.value)).point(j);
    return last.growth - zero;
  };
  if (!(growth(stable.value) < 0.0 && growth(unstable.value) > 0.0)) return unstable.point(j);
  const double value = root(growth, stable.value, unstable.value,
                            limit_error * (b.value - a.value) / unstable.value);
  return {value, 0.0, last.frequency_Hz};
}

}  // namespace

double ExponentSample::frequency_Hz(Index j) const
{
  return std::abs(motion.lambda[j].imag()) / (2.0 * std::numbers::pi);
}

std::vector<ExponentSample> followed_exponents(const ExponentsAt& exponents,
                                               const Eigen::VectorXd& values)
{
  std::vector<ExponentSample> samples(static_cast<std::size_t>(values.size()));
  for_each_index(static_cast<int>(values.size()),
                 [&](int i) { samples[static_cast<std::size_t>(i)] = exponents(values[i]); });
  if (samples.size() == 1) return samples;
  const ExponentSample& first = samples.front();
  const Expected start{first.motion.lambda, first.turns};
  ExponentSample before = first;
  ExponentSample last = ordered(exponents(values[0] + first_step * (values[1] - values[0])), start);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double t = (samples[i].value - before.value) / (last.value - before.value);
    samples[i] = ordered(std::move(samples[i]), expected_at(before, last, t));
    before = samples[i - 1];
    last = samples[i];
  }
  return samples;
}

std::vector<UnstableInterval> unstable_intervals(const ExponentsAt& exponents,
                                                 const std::vector<ExponentSample>& samples,
                                                 Index j)
{
  const auto half_way = [&](const ExponentSample& a, const ExponentSample& b) {
    return sample_between(exponents, a, b, 0.5);
  };
  std::vector<ExponentSample> all = samples;
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    const Neighbours<ExponentSample> t{samples[i - 1], samples[i], samples[i + 1]};
    if (auto other = beyond_extremum(t, j, halvings_of_extremum, half_way))
      all.push_back(std::move(*other));
  }
  std::ranges::stable_sort(all, {}, &ExponentSample::value);
  return intervals_among(all, j, [&](const ExponentSample& a, const ExponentSample& b) {
    return limit_between(exponents, a, b, j);
  });
}

}  // namespace chladni::squeal
