#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "squeal/results/stability_results.hpp"

/// Functions for samples of motions followed over a parameter, however they were computed. A
/// `Sample` provides growth(j), doubt_of(j), is_unstable(j) and point(j) of motion j.
namespace chladni::squeal {

/// Three neighbouring samples.
template <class Sample>
struct Neighbours {
  Sample low, middle, high;
};

/// Signed distance of motion j from a change of the stability that it has in `from`; it changes
/// above zero.
template <class Sample>
double height(const Sample& sample, Eigen::Index j, const Sample& from)
{
  return from.is_unstable(j) ? -sample.growth(j) : sample.growth(j);
}

/// Whether the height has a maximum at the middle sample and may exceed zero near it; see
/// stability_search.cpp.
template <class Sample>
bool may_change(const Neighbours<Sample>& t, Eigen::Index j)
{
  if (t.low.is_unstable(j) != t.middle.is_unstable(j) ||
      t.high.is_unstable(j) != t.middle.is_unstable(j))
    return false;
  const double low = height(t.low, j, t.middle), middle = height(t.middle, j, t.middle),
               high = height(t.high, j, t.middle);
  const double rise = 2.0 * middle - low - high;
  return middle >= low && middle >= high && middle + rise > t.middle.doubt_of(j);
}

/// Searches near the extremum for a sample whose stability differs from that of the middle sample.
/// @param between  (a, b): the sample halfway between a and b
/// @return absent when none is found
template <class Sample, class Between>
std::optional<Sample> beyond_extremum(Neighbours<Sample> t, Eigen::Index j, int halvings,
                                      const Between& between)
{
  for (int k = 0; k < halvings && may_change(t, j); ++k) {
    Sample left = between(t.low, t.middle);
    if (left.is_unstable(j) != t.middle.is_unstable(j)) return left;
    Sample right = between(t.middle, t.high);
    if (right.is_unstable(j) != t.middle.is_unstable(j)) return right;
    const double at_left = height(left, j, t.middle), at_right = height(right, j, t.middle);
    const double in_middle = height(t.middle, j, t.middle);
    if (at_left > in_middle && at_left >= at_right)
      t = {std::move(t.low), std::move(left), std::move(t.middle)};
    else if (at_right > in_middle)
      t = {std::move(t.middle), std::move(right), std::move(t.high)};
    else
      t = {std::move(left), std::move(t.middle), std::move(right)};
  }
  return std::nullopt;
}

/// The intervals of the samples in which motion j grows.
/// @param limit_between  (a, b): limit of stability between two neighbouring samples
template <class Samples, class Limit>
std::vector<UnstableInterval> intervals_among(const Samples& samples, Eigen::Index j,
                                              const Limit& limit_between)
{
  std::vector<UnstableInterval> found;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const StabilityPoint here = samples[i].point(j);
    const bool is = samples[i].is_unstable(j), was = i > 0 && samples[i - 1].is_unstable(j);
    if (is != was) {
      const StabilityPoint limit = i == 0 ? here : limit_between(samples[i - 1], samples[i]);
      if (was)
        found.back().to = limit;
      else
        found.push_back({limit, here, here});
    }
    if (!is) continue;
    found.back().to = here;
    if (here.growth > found.back().worst.growth) found.back().worst = here;
  }
  return found;
}

}  // namespace chladni::squeal
