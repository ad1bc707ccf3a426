#include "reduce/completeness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "linear/kernels/small_matrices.hpp"

namespace chladni::reduce {

using Eigen::MatrixXd;

namespace {

/// Upper bounds of the eigenvalues of K^-1 M above alpha, the first one of Ritz value `first`,
/// descending; what rounding may have taken off is in them.
std::vector<double> upper_bounds(const std::vector<double>& lambda, const MatrixXd& H,
                                 std::size_t first, double alpha)
{
  constexpr double units = 16.0 * std::numeric_limits<double>::epsilon();
  const auto n = static_cast<PetscInt>(lambda.size() - first);
  const auto at = [first](PetscInt i) { return first + static_cast<std::size_t>(i); };
  std::vector<double> root;  // of theta - alpha
  for (PetscInt i = 0; i < n; ++i) root.push_back(std::sqrt(1.0 / lambda[at(i)] - alpha));
  MatrixXd A(n, n);
  double largest = 0.0;
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt i = 0; i < n; ++i) {
      const double product = H(static_cast<PetscInt>(at(i)), static_cast<PetscInt>(at(j))) /
                             (lambda[at(i)] * lambda[at(j)]);
      A(i, j) = product / (root[i] * root[j]) + (i == j ? root[i] * root[i] : 0.0);
    }
    largest = std::max(largest, A(j, j));
  }
  std::vector<double> bounds = linear::symmetric_eigen(std::move(A)).values;
  std::ranges::reverse(bounds);
  for (double& bound : bounds) bound += alpha + units * largest;
  return bounds;
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

double eta2(const ReducedSpectrum& ritz, PetscInt i)
{
  return std::max(0.0, ritz.residuals(i, i));
}

/// In the middle of the widest gap between Ritz values first .. n (counted from 1), the upper ones
/// lowered by their first-order bounds.
double shift_in_gap(const ReducedSpectrum& ritz, std::size_t first, std::size_t n)
{
  double widest = 1.0 + one_cluster;  // a shift between copies would be an eigenvalue
  double shift = shift_above(ritz.lambda, first);
  for (std::size_t i = first - 1; i + 1 < n; ++i) {
    const double next =
        ritz.lambda[i + 1] / (1.0 + std::sqrt(eta2(ritz, static_cast<PetscInt>(i + 1))));
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

/// A projection has no more eigenvalues below sigma than the pencil (Courant and Fischer), but
/// where rounding has more to say than K and M: in a mechanism without mass, or where stiffnesses
/// differ by more digits than numbers have.
EigenvalueCount counted(const EigenvalueCount& count)
{
  if (count.missing() >= 0) return count;
  throw Error(fmt::format(
      "K and M are too close to singular for a count of eigenvalues: {} counted below {:.6g} Hz, "
      "where the reduced model has {}, which can only be rounding; look for a part that nothing "
      "holds and for stiffnesses or masses of very different size, or reduce without the count "
      "(sylvester = false, -cms_sylvester 0, count=False)",
      count.expected, std::sqrt(count.sigma) / (2.0 * std::numbers::pi), count.found));
}

/// The count at a shift, or at one close above or below it if that is an eigenvalue to round-off,
/// which makes the factor or the sign of a pivot fail.
EigenvalueCount count_near(const ReducedSpectrum& ritz, double sigma,
                           const std::function<int(double)>& eigenvalues_below)
{
  constexpr std::array aside{0.0, gap_of_counts, -gap_of_counts,
                             1e-4};  // within what parts two clusters
  for (std::size_t i = 0;; ++i) {
    const double shift = sigma * (1.0 + aside[i]);
    const int found = static_cast<int>(n_below(ritz.lambda, shift)) + ritz.n_zero;
    const bool is_last = i + 1 == aside.size();
    try {
      const EigenvalueCount count{
          .sigma = shift, .expected = eigenvalues_below(shift), .found = found};
      if (count.missing() >= 0 || is_last) return counted(count);
    } catch (const linear::SingularShift&) {
      if (is_last) throw;
    }
  }
}

}  // namespace

std::vector<double> error_bounds(const std::vector<double>& lambda, const MatrixXd& residuals,
                                 double sigma)
{
  constexpr double reach = 1e3;  // low values would bury far higher ones in round-off
  std::vector<double> bounds;
  while (bounds.size() < lambda.size()) {
    const std::size_t first = bounds.size();
    const std::vector<double> upper = upper_bounds(lambda, residuals, first, 1.0 / sigma);
    for (std::size_t i = first; i < lambda.size() && lambda[i] <= reach * lambda[first]; ++i)
      bounds.push_back(std::max(0.0, upper[i - first] * lambda[i] - 1.0));
  }
  return bounds;
}

namespace {

/// Of the Ritz values below sigma, where all of them have a residual.
std::vector<double> bounds_below(const ReducedSpectrum& ritz, double sigma)
{
  const std::ptrdiff_t n = n_below(ritz.lambda, sigma);
  if (n > ritz.residuals.rows()) return {};
  std::vector<double> bounds =
      error_bounds({ritz.lambda.begin(), ritz.lambda.begin() + n}, ritz.residuals, sigma);
  linear::broadcast_numbers(bounds, ritz.comm);  // they decide what is done next
  return bounds;
}

/// Whether the first bound is near its estimate.
bool are_sharp(const std::vector<double>& bounds, const ReducedSpectrum& ritz)
{
  constexpr double near = 10.0, negligible = 1e-10;
  return bounds.empty() || bounds.front() < near * eta2(ritz, 0) + negligible;
}

}  // namespace

EigenvalueCount count_fixed_interface(const std::vector<double>& omega,
                                      const std::function<int(double sigma)>& eigenvalues_below)
{
  constexpr double half_a_pair_gap = 1e-4;  // of omega^2
  ReducedSpectrum modes{.lambda = {}, .residuals = {}, .n_zero = 0, .comm = PETSC_COMM_SELF};
  for (const double omega_k : omega) modes.lambda.push_back(omega_k * omega_k);
  return count_near(modes, modes.lambda.back() * (1.0 + half_a_pair_gap), eigenvalues_below);
}

namespace {

/// Above Ritz value k and its partners; but for a range that is longer or ends before the first
/// one, unless the next Ritz value is so near to the end that its eigenvalue may be below.
double end_of_range(const ReducedSpectrum& ritz, std::size_t k)
{
  constexpr double near = 1.02;
  const double above = shift_above(ritz.lambda, k);
  if (!ritz.ends_at) return above;
  const auto n = static_cast<std::size_t>(n_below(ritz.lambda, *ritz.ends_at));
  const bool is_gap = n == ritz.lambda.size() || ritz.lambda[n] > near * *ritz.ends_at;
  if (n == 0) return is_gap ? *ritz.ends_at : ritz.lambda[0] / (near * near);
  return n <= k && is_gap ? std::max(above, *ritz.ends_at) : above;
}

}  // namespace

Completeness count_modes(ReducedSpectrum ritz,
                         const std::function<int(double sigma)>& eigenvalues_below)
{
  Completeness result;
  linear::broadcast_numbers(linear::values_of(ritz.residuals),
                            ritz.comm);  // they decide what is counted
  const auto k = static_cast<std::size_t>(ritz.residuals.rows());
  if (k == 0) return result;
  const auto count = [&](double sigma) { return count_near(ritz, sigma, eigenvalues_below); };
  result.range = count(end_of_range(ritz, k));
  EigenvalueCount last = result.range;
  for (std::size_t end = k; last.missing() != 0 && end >= 4; end /= 2)
    last = count(shift_in_gap(ritz, end / 2, end));
  if (last.missing() != 0) return result;
  result.complete = last;
  result.bounds = bounds_below(ritz, last.sigma);
  // The last mode, badly found, might as well be any of those before it: a count in a gap below
  // tells them apart.
  for (std::size_t end = k; end >= 4 && !are_sharp(result.bounds, ritz); end /= 2) {
    const EigenvalueCount lower = count(shift_in_gap(ritz, end / 2, end));
    if (lower.missing() != 0 || lower.sigma >= last.sigma) continue;
    const std::vector<double> bounds = bounds_below(ritz, lower.sigma);
    for (std::size_t i = 0; i < bounds.size() && i < result.bounds.size(); ++i)
      result.bounds[i] = std::min(result.bounds[i], bounds[i]);
  }
  return result;
}

}  // namespace chladni::reduce
