#include "reduce/completeness.hpp"

#include <algorithm>
#include <cmath>

namespace chladni::reduce {

namespace {

/// Ritz values first .. end - 1 whose intervals [lambda / (1 + eta), lambda] overlap, and a lower
/// bound of their eigenvalues: p residuals together move p eigenvalues by the root of their
/// squares.
struct Cluster {
  std::size_t first, end;
  double lower;
};

double lower_bound(const std::vector<double>& lambda, const std::vector<double>& eta2,
                   std::size_t first, std::size_t end)
{
  double sum = 0.0;
  for (std::size_t i = first; i < end; ++i) sum += eta2[i];
  return lambda[first] / (1.0 + std::sqrt(sum));
}

std::vector<Cluster> clusters(const std::vector<double>& lambda, const std::vector<double>& eta2)
{
  std::vector<Cluster> found;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    Cluster cluster{i, i + 1, lower_bound(lambda, eta2, i, i + 1)};
    while (!found.empty() && cluster.lower <= lambda[found.back().end - 1]) {
      cluster.first = found.back().first;
      cluster.lower = lower_bound(lambda, eta2, cluster.first, cluster.end);
      found.pop_back();
    }
    found.push_back(cluster);
  }
  return found;
}

double kato_temple(double lambda, double eta2, double next)
{
  const double gap = 1.0 - lambda / next;
  const double eta = std::sqrt(eta2);
  return gap > 0.0 ? std::min(eta, eta2 / gap) : eta;
}

/// What lies around a cluster: an upper bound of the eigenvalue before it (0: none), and a lower
/// one of the next.
struct Neighbours {
  double before, next;
};

/// Bound of |1 / lambda_j - 1 / lambda_j~| for all of a cluster: the norm r of its residuals, or by
/// Li and Li r^2 / (gap to the other Ritz values), which are within r of eigenvalues.
double cluster_bound(const Cluster& cluster, const std::vector<double>& lambda,
                     const std::vector<double>& eta2, const Neighbours& around)
{
  double r2 = 0.0;
  for (std::size_t i = cluster.first; i < cluster.end; ++i) {
    r2 += eta2[i] / (lambda[i] * lambda[i]);
  }
  const double r = std::sqrt(r2);
  double gap = 1.0 / lambda[cluster.end - 1] - 1.0 / around.next;
  if (around.before > 0.0) gap = std::min(gap, 1.0 / around.before - 1.0 / lambda[cluster.first]);
  return gap > 2.0 * r ? std::min(r, r2 / (gap - r)) : r;
}

/// Just above Ritz value n (counted from 1) and its partners.
double shift_above(const std::vector<double>& lambda, std::size_t n)
{
  constexpr double one_cluster = 2e-4;  // of lambda; 1e-4 of the frequency
  constexpr double far_enough = 1.01;
  std::size_t i = n - 1;
  while (i + 1 < lambda.size() && lambda[i + 1] < lambda[i] * (1.0 + one_cluster)) ++i;
  if (i + 1 == lambda.size()) return far_enough * lambda[i];
  return lambda[i] * std::min(far_enough, std::sqrt(lambda[i + 1] / lambda[i]));
}

/// In the middle of the widest gap between Ritz values first .. n (counted from 1), the upper ones
/// lowered by their first-order bounds.
double shift_in_gap(const RitzValues& ritz, std::size_t first, std::size_t n)
{
  double widest = 1.0;
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

}  // namespace

std::vector<double> error_bounds(const std::vector<double>& lambda, const std::vector<double>& eta2,
                                 double sigma)
{
  const std::vector<Cluster> all = clusters(lambda, eta2);
  std::vector<double> bounds;
  for (std::size_t c = 0; c < all.size(); ++c) {
    const double next = c + 1 < all.size() ? all[c + 1].lower : sigma;
    const double before = c > 0 ? lambda[all[c].first - 1] : 0.0;
    const bool alone = all[c].end - all[c].first == 1;
    for (std::size_t i = all[c].first; i < all[c].end; ++i) {
      bounds.push_back(alone ? kato_temple(lambda[i], eta2[i], next)
                             : lambda[i] * cluster_bound(all[c], lambda, eta2, {before, next}));
    }
  }
  return bounds;
}

Completeness count_modes(const RitzValues& ritz,
                         const std::function<int(double sigma)>& eigenvalues_below)
{
  Completeness result;
  const std::size_t k = ritz.eta2.size();
  if (k == 0) return result;
  const auto count = [&](double sigma) -> EigenvalueCount {
    return {.sigma = sigma,
            .expected = eigenvalues_below(sigma),
            .found = static_cast<int>(n_below(ritz.lambda, sigma)) + ritz.n_zero};
  };
  result.range = count(shift_above(ritz.lambda, k));
  EigenvalueCount last = result.range;
  for (std::size_t end = k; last.missing() != 0 && end >= 4; end /= 2) {
    last = count(shift_in_gap(ritz, end / 2, end));
  }
  if (last.missing() != 0) return result;
  result.complete = last;
  const std::ptrdiff_t n = n_below(ritz.lambda, last.sigma);
  if (n > std::ssize(ritz.eta2)) return result;
  result.bounds = error_bounds({ritz.lambda.begin(), ritz.lambda.begin() + n},
                               {ritz.eta2.begin(), ritz.eta2.begin() + n}, last.sigma);
  return result;
}

}  // namespace chladni::reduce
