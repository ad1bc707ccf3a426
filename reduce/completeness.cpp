#include "reduce/completeness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/error.hpp"

namespace chladni::reduce {

namespace {

/// Ritz values theta = 1 / lambda of K^-1 M, descending, and the lengths of their residuals,
/// |K^-1 M u - theta u|_K / |u|_K = theta eta.
struct InverseValues {
  std::vector<double> theta;
  std::vector<double> residual;
};

InverseValues inverse_values(const std::vector<double>& lambda, const std::vector<double>& eta2)
{
  InverseValues values;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    values.theta.push_back(1.0 / lambda[i]);
    values.residual.push_back(std::sqrt(eta2[i]) / lambda[i]);
  }
  return values;
}

/// An upper bound of eigenvalue mu_first from Ritz values first .. last, when mu_(last+1) is at
/// most alpha < theta_last: by Lehmann the eigenvalues of
///   ((Theta - alpha)^2 + R^T R, Theta - alpha)
/// above alpha. Of R^T R the diagonal alone is known; it is at most diag(|r_i| sum_j |r_j|).
double upper_bound(const InverseValues& values, std::size_t first, std::size_t last, double alpha)
{
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) sum += values.residual[i];
  double bound = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const double gap = values.theta[i] - alpha;
    bound = std::max(bound, values.theta[i] + values.residual[i] * sum / gap);
  }
  return bound;
}

/// The least upper bound of mu_first from as many Ritz values as help; `upper` holds those of the
/// eigenvalues behind it, and last of all one of the eigenvalues that were not asked for.
double least_upper_bound(const InverseValues& values, std::size_t first,
                         const std::vector<double>& upper)
{
  constexpr std::size_t widest = 64;  // of a cluster; all that are left are one, too
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = values.theta.size();
  for (std::size_t last = first; last < n; ++last) {
    if (last == first + widest) last = n - 1;
    const double alpha = upper[last + 1];
    if (alpha < values.theta[last])
      least = std::min(least, upper_bound(values, first, last, alpha));
  }
  return least;
}

constexpr double one_cluster = 2e-4;  // of lambda; 1e-4 of the frequency

/// Just above Ritz value n (counted from 1) and its partners.
double shift_above(const std::vector<double>& lambda, std::size_t n)
{
  constexpr double far_enough = 1.01;
  std::size_t i = n - 1;
  while (i + 1 < lambda.size() && lambda[i + 1] < lambda[i] * (1.0 + one_cluster)) ++i;
  if (i + 1 == lambda.size()) return far_enough * lambda[i];
  return lambda[i] * std::min(far_enough, std::sqrt(lambda[i + 1] / lambda[i]));
}

/// In the middle of the widest gap between Ritz values first .. n (counted from 1), the upper ones
/// lowered by their first-order bounds.
double shift_in_gap(const ReducedSpectrum& ritz, std::size_t first, std::size_t n)
{
  double widest = 1.0 + one_cluster;  // a shift between copies would be an eigenvalue
  double shift = shift_above(ritz.lambda, first);
  for (std::size_t i = first - 1; i + 1 < n; ++i) {
    const double next = ritz.lambda[i + 1] / (1.0 + std::sqrt(ritz.eta2[i + 1]));
    if (next / ritz.lambda[i] <= widest) continue;
    widest = next / ritz.lambda[i];
    shift = std::sqrt(ritz.lambda[i] * next);
  }
  return shift;
}

std::ptrdiff_t n_below(const std::vector<double>& lambda, double sigma)
{
  return std::ranges::lower_bound(lambda, sigma) - lambda.begin();
}

/// A projection has no more eigenvalues below sigma than the pencil (Courant and Fischer).
EigenvalueCount counted(const EigenvalueCount& count)
{
  if (count.missing() >= 0) return count;
  throw Error(fmt::format(
      "internal error: {} eigenvalues counted below {:.15g} rad^2/s^2, where the reduced model has "
      "{}: a projection cannot have more of them; the pivots of K - sigma M are not to be trusted",
      count.expected, count.sigma, count.found));
}

/// The count at a shift, or at one close above or below it if that is an eigenvalue to round-off,
/// which makes the factor or the sign of a pivot fail.
EigenvalueCount count_near(const ReducedSpectrum& ritz, double sigma,
                           const std::function<int(double)>& eigenvalues_below)
{
  constexpr std::array aside{0.0, 3e-5, -3e-5, 1e-4};  // within what parts two clusters
  for (std::size_t i = 0;; ++i) {
    const double shift = sigma * (1.0 + aside[i]);
    const int found = static_cast<int>(n_below(ritz.lambda, shift)) + ritz.n_zero;
    const bool is_last = i + 1 == aside.size();
    try {
      const EigenvalueCount count{
          .sigma = shift, .expected = eigenvalues_below(shift), .found = found};
      if (count.missing() >= 0 || is_last) return counted(count);
    } catch (const SingularShift&) {
      if (is_last) throw;
    }
  }
}

}  // namespace

std::vector<double> error_bounds(const std::vector<double>& lambda, const std::vector<double>& eta2,
                                 double sigma)
{
  const InverseValues values = inverse_values(lambda, eta2);
  std::vector<double> upper(lambda.size() + 1, 1.0 / sigma);
  std::vector<double> bounds(lambda.size(), 0.0);
  for (std::size_t i = lambda.size(); i-- > 0;) {
    upper[i] = least_upper_bound(values, i, upper);
    bounds[i] = upper[i] * lambda[i] - 1.0;
  }
  return bounds;
}

namespace {

/// Of the Ritz values below sigma, where all of them have a residual.
std::vector<double> bounds_below(const ReducedSpectrum& ritz, double sigma)
{
  const std::ptrdiff_t n = n_below(ritz.lambda, sigma);
  if (n > std::ssize(ritz.eta2)) return {};
  return error_bounds({ritz.lambda.begin(), ritz.lambda.begin() + n},
                      {ritz.eta2.begin(), ritz.eta2.begin() + n}, sigma);
}

/// Whether the first bound is near its estimate.
bool are_sharp(const std::vector<double>& bounds, const std::vector<double>& eta2)
{
  constexpr double near = 10.0, negligible = 1e-10;
  return bounds.empty() || bounds.front() < near * eta2.front() + negligible;
}

}  // namespace

EigenvalueCount count_fixed_interface(const std::vector<double>& omega,
                                      const std::function<int(double sigma)>& eigenvalues_below)
{
  constexpr double half_a_pair_gap = 1e-4;  // of omega^2
  ReducedSpectrum modes{.lambda = {}, .eta2 = {}, .n_zero = 0};
  for (const double omega_k : omega) modes.lambda.push_back(omega_k * omega_k);
  return count_near(modes, modes.lambda.back() * (1.0 + half_a_pair_gap), eigenvalues_below);
}

Completeness count_modes(const ReducedSpectrum& ritz,
                         const std::function<int(double sigma)>& eigenvalues_below)
{
  Completeness result;
  const std::size_t k = ritz.eta2.size();
  if (k == 0) return result;
  const auto count = [&](double sigma) { return count_near(ritz, sigma, eigenvalues_below); };
  result.range = count(shift_above(ritz.lambda, k));
  EigenvalueCount last = result.range;
  for (std::size_t end = k; last.missing() != 0 && end >= 4; end /= 2) {
    last = count(shift_in_gap(ritz, end / 2, end));
  }
  if (last.missing() != 0) return result;
  result.complete = last;
  result.bounds = bounds_below(ritz, last.sigma);
  // The large residuals of the last modes may leave nothing for the first ones: a count in a gap
  // below does.
  for (std::size_t end = k; end >= 4 && !are_sharp(result.bounds, ritz.eta2); end /= 2) {
    const EigenvalueCount lower = count(shift_in_gap(ritz, end / 2, end));
    if (lower.missing() != 0 || lower.sigma >= last.sigma) continue;
    const std::vector<double> bounds = bounds_below(ritz, lower.sigma);
    for (std::size_t i = 0; i < bounds.size() && i < result.bounds.size(); ++i) {
      result.bounds[i] = std::min(result.bounds[i], bounds[i]);
    }
  }
  return result;
}

}  // namespace chladni::reduce
