#include "squeal/stability/mode_limits.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

#include "squeal/stability/followed_samples.hpp"
#include "squeal/stability/hopf.hpp"

namespace chladni::squeal {
namespace {

using Eigen::Index;

/// Halvings of the distance of two samples before Newton's method starts, and at most.
constexpr int halvings_before_newton = 7;
constexpr int halvings_max = 60;
/// Halvings of the distance in the search for an extremum.
constexpr int halvings_of_extremum = 20;
/// How near Newton's frequency must be to that of the motion at Newton's value, relative.
constexpr double same_frequency = 1e-6;

double frequency_distance(const ModeSample& sample, Index j, Index k)
{
  return (sample.lambda[j] - sample.lambda[k]).imag();
}

/// Where the frequencies of two stable motions are one, by linear interpolation.
std::vector<ModeSample> at_crossings(const StateMatrixOf& A, const ModeSample& low,
                                     const ModeSample& high, const std::vector<Index>& which)
{
  std::vector<ModeSample> found;
  const auto is_stable = [&](Index j) { return !low.is_unstable(j) && !high.is_unstable(j); };
  for (const Index j : which) {
    for (const Index k : which) {
      if (k <= j || !is_stable(j) || !is_stable(k)) continue;
      const double a = frequency_distance(low, j, k), b = frequency_distance(high, j, k);
      // Frequencies that differ by rounding alone do not cross.
      if (a * b < 0.0 && std::abs(a - b) > 1e3 * (low.doubt[j] + low.doubt[k]))
        found.push_back(mode_sample_between(A, low, high, a / (a - b)));
    }
  }
  return found;
}

/// Two samples, without and with growth of a motion.
struct Bracket {
  ModeSample stable, unstable;

  double width() const { return std::abs(unstable.value - stable.value); }
  bool holds(double value) const
  {
    return std::abs(value - stable.value) <= width() && std::abs(value - unstable.value) <= width();
  }
};

/// Halved so many times, or until it holds no number between its ends.
Bracket halved(const StateMatrixOf& A, Bracket b, Index j, int times)
{
  for (int k = 0; k < times; ++k) {
    ModeSample middle = mode_sample_between(A, b.stable, b.unstable, 0.5);
    if (middle.value == b.stable.value || middle.value == b.unstable.value) break;
    (middle.is_unstable(j) ? b.unstable : b.stable) = std::move(middle);
  }
  return b;
}

StabilityPoint limit_within(const StateMatrixOf& A, const Bracket& wide, Index j)
{
  const Bracket near = halved(A, wide, j, halvings_before_newton);
  const ModeSample& at = near.unstable;
  const auto newton = hopf_point(A, at.value, at.lambda[j].imag(), at.X.col(j));
  // The doubt may hide the first growth of a slow motion: then Newton's value is below the bracket.
  if (newton && Bracket{wide.stable, near.unstable}.holds(newton->value)) {
    const double t = near.width() > 0.0 ? (newton->value - near.stable.value) /
                                              (near.unstable.value - near.stable.value)
                                        : 0.0;
    const ModeSample there = mode_sample_between(A, near.stable, near.unstable, t);
    const std::complex<double> i_omega(0.0, newton->omega);
    if (std::abs(there.lambda[j] - i_omega) < same_frequency * std::abs(newton->omega)) {
      return {newton->value, 0.0, std::abs(newton->omega) / (2.0 * std::numbers::pi),
              newton->n_newton_steps};
    }
  }
  StabilityPoint limit = halved(A, near, j, halvings_max).unstable.point(j);
  limit.growth = 0.0;
  return limit;
}

}  // namespace

std::vector<ModeSample> with_hidden_changes(const StateMatrixOf& A, std::vector<ModeSample> samples,
                                            const std::vector<Index>& which)
{
  if (samples.size() < 2) return samples;
  // The last intervals are halved: an extremum may be within them.
  samples.insert(samples.begin() + 1, mode_sample_between(A, samples[0], samples[1], 0.5));
  samples.insert(samples.end() - 1,
                 mode_sample_between(A, samples.end()[-2], samples.end()[-1], 0.5));
  const auto half_way = [&A](const ModeSample& a, const ModeSample& b) {
    return mode_sample_between(A, a, b, 0.5);
  };
  std::vector<ModeSample> more;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    std::ranges::move(at_crossings(A, samples[i - 1], samples[i], which), std::back_inserter(more));
    if (i + 1 == samples.size()) break;
    for (const Index j : which) {
      const Neighbours<ModeSample> t{samples[i - 1], samples[i], samples[i + 1]};
      if (auto sample = beyond_extremum(t, j, halvings_of_extremum, half_way))
        more.push_back(std::move(*sample));
    }
  }
  std::ranges::move(more, std::back_inserter(samples));
  std::ranges::stable_sort(samples, {}, &ModeSample::value);
  return samples;
}

std::vector<UnstableInterval> unstable_intervals(const StateMatrixOf& A,
                                                 const std::vector<ModeSample>& samples, Index j)
{
  return intervals_among(samples, j, [&](const ModeSample& a, const ModeSample& b) {
    return limit_within(A, a.is_unstable(j) ? Bracket{b, a} : Bracket{a, b}, j);
  });
}

}  // namespace chladni::squeal
