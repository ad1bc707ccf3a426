#include "squeal/stability/stability_search.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/stability_map.hpp"

namespace chladni::squeal {

namespace {

using Complex = std::complex<double>;

/// Width of the bracket, relative to the distance of the samples, from which Newton's method
/// starts.
constexpr double bracket = 1e-4;
/// Distance of values, relative to that of the samples, at which the search for an extremum ends.
constexpr double resolution = 1e-6;
/// Of values at which two branches have one frequency: linear interpolation, and the secant method.
constexpr int secant_steps = 2;

/// Three samples at equal distances.
struct Triple {
  StabilitySample low, middle, high;
};

/// Something that a sample may have too little of to be of the other stability.
using Height = std::function<double(const StabilitySample&)>;

/// Whether the height is largest in the middle and may rise above zero beside it. A parabola
/// through the three rises above the middle by an eighth of its second difference, two straight
/// lines by half of it: all of it leaves a margin.
bool may_rise_above_zero(const Triple& t, const Height& height)
{
  const double middle = height(t.middle), low = height(t.low), high = height(t.high);
  const double rise = 2.0 * middle - low - high;
  return middle >= low && middle >= high && middle + rise > rounding_of(t.middle.lambda);
}

/// A sample of the other stability about the maximum of the height, which is followed by halving
/// the distances.
std::optional<StabilitySample> beyond_maximum(const StateMatrixOf& A, Triple t,
                                              const Height& height)
{
  const double smallest = resolution * (t.high.value - t.low.value);
  const bool unstable = t.middle.unstable;
  while (t.high.value - t.low.value > smallest && may_rise_above_zero(t, height)) {
    StabilitySample left = sample_between(A, t.low, t.middle, 0.5);
    if (left.unstable != unstable) return left;
    StabilitySample right = sample_between(A, t.middle, t.high, 0.5);
    if (right.unstable != unstable) return right;
    if (height(left) > height(t.middle) && height(left) >= height(right))
      t = {std::move(t.low), std::move(left), std::move(t.middle)};
    else if (height(right) > height(t.middle))
      t = {std::move(t.middle), std::move(right), std::move(t.high)};
    else
      t = {std::move(left), std::move(t.middle), std::move(right)};
  }
  return std::nullopt;
}

/// What may hide beside the middle of three samples of one stability.
std::vector<StabilitySample> beyond_maxima(const StateMatrixOf& A, const Triple& t)
{
  std::vector<StabilitySample> found;
  if (t.middle.unstable) {
    const auto depth = [](const StabilitySample& sample) { return -sample.growth(); };
    if (auto sample = beyond_maximum(A, t, depth)) found.push_back(std::move(*sample));
    return found;
  }
  for (Eigen::Index j = 0; j < t.middle.lambda.size(); ++j) {
    const auto growth = [j](const StabilitySample& sample) { return sample.lambda[j].real(); };
    if (auto sample = beyond_maximum(A, t, growth)) found.push_back(std::move(*sample));
  }
  return found;
}

/// Every three neighbours, and at each end of the range the last interval with its middle.
std::vector<Triple> triples(const StateMatrixOf& A, const std::vector<StabilitySample>& samples)
{
  const auto halved = [&](const StabilitySample& low, const StabilitySample& high) {
    return Triple{low, sample_between(A, low, high, 0.5), high};
  };
  std::vector<Triple> all = {halved(samples[0], samples[1])};
  for (std::size_t i = 1; i + 1 < samples.size(); ++i)
    all.push_back({samples[i - 1], samples[i], samples[i + 1]});
  all.push_back(halved(samples.end()[-2], samples.end()[-1]));
  return all;
}

/// Two branches whose frequencies cross between two samples.
struct Crossing {
  Eigen::Index j, k;

  double distance(const StabilitySample& s) const { return (s.lambda[j] - s.lambda[k]).imag(); }
};

std::vector<Crossing> crossings(const StabilitySample& a, const StabilitySample& b)
{
  const double degenerate = 1e3 * rounding_of(a.lambda);
  std::vector<Crossing> found;
  for (Eigen::Index j = 0; j < a.lambda.size(); ++j) {
    for (Eigen::Index k = j + 1; k < a.lambda.size(); ++k) {
      const Crossing at{j, k};
      const double at_a = at.distance(a), at_b = at.distance(b);
      if (at_a * at_b < 0.0 && std::abs(at_a - at_b) > degenerate) found.push_back(at);
    }
  }
  return found;
}

/// Samples where two branches have one frequency, between two samples in which nothing grows.
std::vector<StabilitySample> at_crossings(const StateMatrixOf& A, const StabilitySample& a,
                                          const StabilitySample& b)
{
  std::vector<StabilitySample> found;
  for (const Crossing& crossing : crossings(a, b)) {
    StabilitySample low = a, high = b;
    for (int step = 0; step < secant_steps; ++step) {
      const double at_low = crossing.distance(low), at_high = crossing.distance(high);
      StabilitySample at = sample_between(A, low, high, at_low / (at_low - at_high));
      found.push_back(at);
      if (at.unstable || crossing.distance(at) == 0.0) break;
      (crossing.distance(at) * at_low > 0.0 ? low : high) = std::move(at);
    }
  }
  return found;
}

/// The samples of a scan, and those between them at which stability may change and change back.
std::vector<StabilitySample> with_those_between(const StateMatrixOf& A,
                                                std::vector<StabilitySample> samples)
{
  std::vector<StabilitySample> more;
  const auto add = [&](std::vector<StabilitySample> found) {
    std::move(found.begin(), found.end(), std::back_inserter(more));
  };
  for (const Triple& t : triples(A, samples)) {
    more.push_back(t.middle);
    if (t.low.unstable == t.middle.unstable && t.high.unstable == t.middle.unstable)
      add(beyond_maxima(A, t));
  }
  for (std::size_t i = 0; i + 1 < samples.size(); ++i)
    if (!samples[i].unstable && !samples[i + 1].unstable)
      add(at_crossings(A, samples[i], samples[i + 1]));
  std::move(more.begin(), more.end(), std::back_inserter(samples));
  std::ranges::stable_sort(samples, [](const StabilitySample& x, const StabilitySample& y) {
    return x.value < y.value;
  });
  return samples;
}

double frequency_of(const Complex& lambda)
{
  return std::abs(lambda.imag()) / (2.0 * std::numbers::pi);
}

StabilityPoint point_of(const StabilitySample& sample)
{
  Eigen::Index i = 0;
  const double growth = sample.lambda.real().maxCoeff(&i);
  return {sample.value, growth, frequency_of(sample.lambda[i])};
}

/// A value without and one with growth.
struct ValueBracket {
  double stable, unstable;

  double width() const { return std::abs(unstable - stable); }
};

/// Bisected until it is so wide, or holds no number between its ends.
template <class IsUnstable>
ValueBracket narrowed(ValueBracket b, double width, const IsUnstable& is_unstable_at)
{
  while (b.width() > width) {
    const double middle = 0.5 * (b.stable + b.unstable);
    if (middle == b.stable || middle == b.unstable) break;
    (is_unstable_at(middle) ? b.unstable : b.stable) = middle;
  }
  return b;
}

/// Newton's method from the unstable end, if it ends within the bracket where nothing grows.
std::optional<StabilityPoint> polished(const StateMatrixOf& A, const ValueBracket& b)
{
  const EigenPair growing = least_stable_pair(A(b.unstable));
  const auto point = hopf_point(A, b.unstable, growing.lambda.imag(), growing.u);
  if (!point || !(std::abs(point->value - b.stable) <= b.width()) ||
      !(std::abs(point->value - b.unstable) <= b.width()) || is_unstable(A(point->value)))
    return std::nullopt;
  return StabilityPoint{point->value, 0.0, frequency_of({0.0, point->omega}),
                        point->n_newton_steps};
}

/// Where stability changes between two samples.
StabilityPoint limit_between(const StateMatrixOf& A, const StabilitySample& a,
                             const StabilitySample& b, double distance)
{
  const ValueBracket wide =
      a.unstable ? ValueBracket{b.value, a.value} : ValueBracket{a.value, b.value};
  const StabilitySample& stable = a.unstable ? b : a;
  // Where all motions decay, growth is found by its sign; beside a neutral one, by its doubt.
  const bool decays = stable.growth() < -rounding_of(stable.lambda);
  const auto unstable_at = [&](double value) {
    const Eigen::MatrixXd A_here = A(value);
    return decays ? least_stable_eigenvalue(A_here).real() > 0.0 : is_unstable(A_here);
  };
  const ValueBracket near = narrowed(wide, bracket * distance, unstable_at);
  // The doubt may hide the first growth of a slow motion: then Newton's value is below the bracket.
  if (const auto point = polished(A, decays ? near : ValueBracket{wide.stable, near.unstable}))
    return *point;
  const double value = narrowed(near, 0.0, unstable_at).unstable;
  return {value, 0.0, frequency_of(least_stable_eigenvalue(A(value)))};
}

/// The unstable samples between limits of stability.
std::vector<UnstableInterval> intervals(const StateMatrixOf& A,
                                        const std::vector<StabilitySample>& samples,
                                        double distance)
{
  std::vector<UnstableInterval> found;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const StabilityPoint here = point_of(samples[i]);
    const bool was_unstable = i > 0 && samples[i - 1].unstable;
    if (samples[i].unstable != was_unstable) {
      const StabilityPoint limit =
          i > 0 ? limit_between(A, samples[i - 1], samples[i], distance) : here;
      if (was_unstable)
        found.back().to = limit;
      else
        found.push_back({limit, here, here});
    }
    if (!samples[i].unstable) continue;
    found.back().to = here;
    if (here.growth > found.back().worst.growth) found.back().worst = here;
  }
  return found;
}

/// @param scanned  equally spaced
StabilityProfile profile_of(const StateMatrixOf& A, std::vector<StabilitySample> scanned)
{
  const double distance = scanned[1].value - scanned[0].value;
  const std::vector<StabilitySample> samples = with_those_between(A, std::move(scanned));
  return {point_of(samples.front()), point_of(samples.back()), intervals(A, samples, distance)};
}

}  // namespace

StabilityProfile stability_over(const StateMatrixOf& A, const SearchRange& range)
{
  return profile_of(A, scan(A, range));
}

StabilityProfile stability_until_loss(const StateMatrixOf& A, const SearchRange& range)
{
  return profile_of(A, scan_until_loss(A, range));
}

namespace {

/// Growth that rounding can make of a neutral motion whose eigenvalue has the condition 1, relative
/// to the largest eigenvalue.
constexpr double growth_rounding = 1e-12;
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
  if (growth > zero * (beyond_doubt / growth_rounding)) return true;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success)
    throw Error("eigenvalues of the sliding disc: the QR iteration did not converge");
  const Eigen::VectorXd kappa = conditions(solver.eigenvectors());
  for (Eigen::Index i = 0; i < kappa.size(); ++i) {
    // Two eigenvectors that are the same to the last digit have no finite condition.
    const double doubt = std::isfinite(kappa[i]) ? kappa[i] : beyond_doubt / growth_rounding;
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
  return growth_rounding * lambda.cwiseAbs().maxCoeff();
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

namespace {

constexpr int limit_newton_steps_max = 30;
constexpr int values_scanned = 128;
/// Change of omega, and a hundredth of that of the value, relative, at which Newton's method has
/// converged.
constexpr double limit_converged = 1e-13;
/// The same where it no longer falls: rounding, which in a large system is what remains.
constexpr double converged_at_rounding = 1e-10;
/// Step of the central difference of A, relative to the value: A is smooth in it, and rounding and
/// truncation both stay below 1e-9, which slows the last steps of Newton's method only.
constexpr double difference_by_value = 1e-5;

/// g and its derivatives at (value, omega).
struct Bordered {
  Complex g, g_omega, g_value;
  Eigen::VectorXcd u;
};

Bordered bordered(const StateMatrixOf& A, double value, double omega,
                  const Eigen::VectorXcd& border)
{
  const Eigen::Index n = border.size();
  const Complex i(0.0, 1.0);
  Eigen::MatrixXcd B = Eigen::MatrixXcd::Zero(n + 1, n + 1);
  B.topLeftCorner(n, n) = A(value).cast<Complex>();
  // Scaled to the size of A, for the system to be well scaled.
  const double scale = B.topLeftCorner(n, n).cwiseAbs().maxCoeff();
  B.topLeftCorner(n, n).diagonal().array() -= i * omega;
  B.col(n).head(n) = scale * border;
  B.row(n).head(n) = scale * border.adjoint();
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(B), adjoint(B.adjoint());
  const Eigen::VectorXcd unit = scale * Eigen::VectorXcd::Unit(n + 1, n);
  const Eigen::VectorXcd x = lu.solve(unit), y = adjoint.solve(unit);
  const Eigen::VectorXcd u = x.head(n), w = y.head(n);
  const double step = difference_by_value * std::abs(value);
  const Eigen::MatrixXd A_value = (A(value + step) - A(value - step)) / (2.0 * step);
  return {x[n], w.dot(i * u) / scale, -w.dot(A_value * u) / scale, u};
}

}  // namespace

std::optional<HopfPoint> hopf_point(const StateMatrixOf& A, double value, double omega,
                                    const Eigen::VectorXcd& u)
{
  Eigen::VectorXcd border = u.normalized();
  double last = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= limit_newton_steps_max; ++k) {
    const Bordered at = bordered(A, value, omega, border);
    Eigen::Matrix2d J;
    J << at.g_omega.real(), at.g_value.real(), at.g_omega.imag(), at.g_value.imag();
    const Eigen::Vector2d change =
        -J.partialPivLu().solve(Eigen::Vector2d(at.g.real(), at.g.imag()));
    omega += change[0];
    value += change[1];
    border = at.u.normalized();
    if (!std::isfinite(omega) || !std::isfinite(value)) return std::nullopt;
    const double size = std::max(std::abs(change[0] / omega), 1e-2 * std::abs(change[1] / value));
    if (size <= limit_converged || (size <= converged_at_rounding && size >= 0.5 * last))
      return HopfPoint{value, omega, border, k};
    last = size;
  }
  return std::nullopt;
}

CriticalValue critical_value(const Brake& brake, const CriticalCase& search)
{
  const StateMatrixOf A = [&](double value) {
    return brake.with(search.parameter, value)->state_matrix(search.speed);
  };
  return critical_value(
      search, stability_over(A, {.from = search.from, .to = search.to, .count = values_scanned}));
}

CriticalValue critical_value(const CriticalCase& search, StabilityProfile profile)
{
  std::optional<StabilityPoint> limit = first_loss(profile);
  if (!limit) limit = first_regain(profile);
  return {.parameter = key_of(search.parameter),
          .speed = search.speed,
          .value = limit ? std::optional(limit->value) : std::nullopt,
          .frequency_Hz = limit ? limit->frequency_Hz : 0.0,
          .n_newton_steps = limit ? limit->n_newton_steps : 0,
          .profile = std::move(profile)};
}

}  // namespace chladni::squeal
