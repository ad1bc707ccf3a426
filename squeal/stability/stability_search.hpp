#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// State matrix A of x' = A x as a function of the parameter.
using StateMatrixOf = std::function<Eigen::MatrixXd(double value)>;

/// A value at which A has the eigenvalues +-i omega.
struct HopfPoint {
  double value;        ///< value of the parameter
  double omega;        ///< rad/s
  Eigen::VectorXcd u;  ///< eigenvector of i omega with norm 1
  int n_newton_steps;
};

/// Newton's method on g(omega, value) = 0, where g is the last component of the bordered system
///   [A(value) - i omega I, b; c^H, 0] (u; g) = (0; 1),
/// which remains regular when A - i omega I is singular. Derivatives of g come from the adjoint
/// system, those of A from central differences. Convergence is quadratic: about four steps to
/// rounding.
/// @param value, omega  start values
/// @param u             [n] estimate of the eigenvector, from which b and c are made
/// @return absent when it does not converge within 30 steps
std::optional<HopfPoint> hopf_point(const StateMatrixOf& A, double value, double omega,
                                    const Eigen::VectorXcd& u);

/// The value of a parameter where the sliding brake loses its stability, at the speed of the
/// search; see stability_search.hpp. 128 values are sampled first. For the speed itself use
/// `critical_speed`.
/// @return `value` is the first loss of stability or, if it is never lost, the first regain; absent
///         if neither is in the range
CriticalValue critical_value(const Brake& brake, const CriticalCase& search);

/// What a search found, from its profile.
CriticalValue critical_value(const CriticalCase& search, StabilityProfile profile);

/// A range of a parameter, of which `count` equally spaced values are sampled first.
struct SearchRange {
  double from;
  double to;
  int count;  ///< at least 3
};

/// Intervals of a parameter in which x' = A x is unstable.
///
/// A motion counts as unstable when it grows faster than rounding errors can cause: 1e-12 of the
/// largest |lambda|, times the condition number of the eigenvalue. A rigid or undamped motion is
/// therefore stable and does not hide others.
///
/// The largest real part of all eigenvalues is continuous in the parameter even where branches
/// cross, so each change of stability between two samples is bracketed by bisection. Newton's
/// method (hopf.hpp) refines the limit only if its result is within the last bracket and no other
/// motion grows there; then sliding is stable on one side and unstable on the other, within the
/// width of the bracket. Between samples of equal stability the search follows
///  - maxima of the real part of each branch that may exceed zero,
///  - minima of the largest real part that may fall below zero,
///  - values at which two branches have the same frequency, where modes couple in a narrow
///    interval.
/// Other instabilities that are narrower than the distance of the samples are not found.
StabilityProfile stability_over(const StateMatrixOf& A, const SearchRange& range);

/// As stability_over, but where stability is lost the range ends just above: for those who ask for
/// nothing beyond, which may be most of the range.
StabilityProfile stability_until_loss(const StateMatrixOf& A, const SearchRange& range);

/// The eigenvalues of A at one value of the parameter.
struct StabilitySample {
  double value;
  Eigen::VectorXcd lambda;  ///< one for each mode, in the order of the branches
  bool unstable;

  double growth() const { return lambda.real().maxCoeff(); }
};

/// Whether x' = A x grows faster than rounding errors can make a neutral motion grow; see
/// stability_over.
bool is_unstable(const Eigen::MatrixXd& A);

/// Growth rate, 1/s, that rounding errors may cause for a neutral motion whose eigenvalue has the
/// condition number 1.
double rounding_of(const Eigen::VectorXcd& lambda);

/// Equally spaced samples, with branches followed by extrapolation.
std::vector<StabilitySample> scan(const StateMatrixOf& A, const SearchRange& range);

/// Those of `scan` up to the first that is unstable after a stable one.
std::vector<StabilitySample> scan_until_loss(const StateMatrixOf& A, const SearchRange& range);

/// The sample between two others, at t = 0 ... 1 from the first to the second.
StabilitySample sample_between(const StateMatrixOf& A, const StabilitySample& low,
                               const StabilitySample& high, double t);

}  // namespace chladni::squeal

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

/// Whether the height has a maximum at the middle one of three samples and may exceed zero near it;
/// see stability_search.cpp.
template <class Sample>
bool may_change(const Sample& low_one, const Sample& middle_one, const Sample& high_one,
                Eigen::Index j)
{
  if (low_one.is_unstable(j) != middle_one.is_unstable(j) ||
      high_one.is_unstable(j) != middle_one.is_unstable(j))
    return false;
  const double low = height(low_one, j, middle_one), middle = height(middle_one, j, middle_one),
               high = height(high_one, j, middle_one);
  const double rise = 2.0 * middle - low - high;
  return middle >= low && middle >= high && middle + rise > middle_one.doubt_of(j);
}

/// Searches near the extremum for a sample whose stability differs from that of the middle sample.
/// @param between  (a, b): the sample halfway between a and b
/// @return absent when none is found
template <class Sample, class Between>
std::optional<Sample> beyond_extremum(Neighbours<Sample> t, Eigen::Index j, int halvings,
                                      const Between& between)
{
  for (int k = 0; k < halvings && may_change(t.low, t.middle, t.high, j); ++k) {
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
