#include "reduce/completeness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "chain.hpp"
#include "reduce/condition_estimate.hpp"
#include "reduce/sylvester.hpp"

namespace chladni::reduce {
namespace {

constexpr PetscInt n = 40;  // masses

/// Eigenvalue k = 0, 1, ... of the free chain.
double free_eigenvalue(int k)
{
  return std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / n), 2);
}

TEST(EigenvaluesBelow, CountsThoseOfTheFreeChain)
{
  const testing::Chain chain = testing::free_chain(n);
  for (const int k : {1, 7, 39}) {
    const double sigma = 0.5 * (free_eigenvalue(k - 1) + free_eigenvalue(k));
    EXPECT_EQ(eigenvalues_below(chain.K, chain.M, sigma), k);
  }
  EXPECT_EQ(eigenvalues_below(chain.K, chain.M, 5.0), n);  // all are below 4
}

TEST(EigenvaluesBelow, CountsWithoutTheHeldDofs)
{
  const testing::Chain chain = testing::free_chain(n);
  const auto held_eigenvalue = [](int k) {  // n - 2 masses between fixed ends
    return std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / (n - 1)), 2);
  };
  const double sigma = 0.5 * (held_eigenvalue(9) + held_eigenvalue(10));
  EXPECT_EQ(eigenvalues_below(chain.K, chain.M, sigma, {n - 1, 0}), 9);
}

TEST(ConditionEstimate, IsExactForTheChainBetweenFixedEnds)
{
  const testing::Chain chain = testing::free_chain(n + 1);
  const DofPartition dofs = partition(chain.K, testing::master_set(chain.K, {0, n}));
  const Blocks K = split(chain.K, dofs);
  // |K|_1 = 4; column j of the inverse sums to j (m + 1 - j) / 2, at most (m + 1)^2 / 8, m = n - 1.
  EXPECT_NEAR(condition_estimate(factorize(K.ss)), 4.0 * n * n / 8.0, 1e-9 * n * n);  // round-off
}

/// A symmetric matrix with eigenvalues 1 and 10 and its Ritz value in the direction (cos, sin).
struct TwoByTwo {
  double angle;

  double ritz() const
  {
    return 1.0 / (std::pow(std::cos(angle), 2) + 0.1 * std::pow(std::sin(angle), 2));
  }
  /// |K^-1 - rho| of the unit vector, times lambda~.
  double eta2() const { return std::pow(0.9 * std::sin(angle) * std::cos(angle) * ritz(), 2); }
};

TEST(ErrorBounds, AreSharpWhereTheNextEigenvalueIsKnown)
{
  const TwoByTwo pencil{.angle = 0.1};
  const auto bounds = error_bounds({pencil.ritz()}, {pencil.eta2()}, 10.0);
  // Temple's inequality is an equation for a vector out of two eigenvectors.
  EXPECT_NEAR(bounds[0], pencil.ritz() - 1.0, 1e-15);
}

TEST(ErrorBounds, OfTwoCloseValuesHoldForBoth)
{
  // Eigenvalues 1, 1.0001 and 10 in K^-1; Ritz vectors are the first two turned towards the third.
  const double theta[] = {1.0, 1.0 / 1.0001, 0.1};
  std::vector<double> lambda, eta2;
  for (int i = 0; i < 2; ++i) {
    const double c = std::cos(0.02), s = std::sin(0.02) / std::numbers::sqrt2;
    const double rho = theta[i] * c * c + theta[2] * s * s + theta[2] * s * s;  // two far ones
    const double r2 = std::pow((theta[i] - rho) * c, 2) + 2.0 * std::pow((theta[2] - rho) * s, 2);
    lambda.push_back(1.0 / rho);
    eta2.push_back(r2 / (rho * rho));
  }
  const auto bounds = error_bounds(lambda, eta2, 9.0);
  for (int i = 0; i < 2; ++i) {
    const double error = lambda[i] * theta[i] - 1.0;
    EXPECT_GE(bounds[i], error);
    EXPECT_LE(bounds[i], 3.0 * error);  // of second order: 2 residuals, a gap of 0.89, no more
  }
}

TEST(ErrorBounds, OfTheLastValueReachBeyondSigma)
{
  // K = [[100.1, -.1], [-.1, 1.1]], M = diag(1, 1000) condensed to its first DOF: the eigenvalues
  // are near 0.0011 and 100, and the only Ritz value is near the upper one.
  const double K[] = {100.1, -0.1, 1.1}, m[] = {1.0, 1000.0};
  const double psi = -K[1] / K[2];
  const double lambda = (K[0] + K[1] * psi) / (m[0] + psi * psi * m[1]);
  const double r_s = lambda * m[1] * psi;  // for u = (1, psi)
  const double mass = m[0] + psi * psi * m[1];
  const double eta2 = r_s * r_s / K[2] / lambda / mass;
  const double b = K[0] / m[0] + K[2] / m[1], c = (K[0] * K[2] - K[1] * K[1]) / (m[0] * m[1]);
  const double exact = 2.0 * c / (b + std::sqrt(b * b - 4.0 * c));
  EXPECT_GE(error_bounds({lambda}, {eta2}, 1.01 * lambda)[0], lambda / exact - 1.0);
}

TEST(CountModes, RefusesACountBelowWhatIsThere)
{
  EXPECT_THROW(count_modes({.lambda = {1.0, 2.0}, .eta2 = {1e-8, 1e-8}, .n_zero = 0},
                           [](double) { return 1; }),
               Error);
}

TEST(CountModes, FindsTheModeThatIsMissing)
{
  const std::vector<double> full = {1.0, 2.0, 4.0, 7.0, 11.0, 16.0, 22.0};
  const auto below = [&](double sigma) {
    return static_cast<int>(std::ranges::lower_bound(full, sigma) - full.begin());
  };
  const std::vector<double> tiny(5, 1e-8);
  const auto whole =
      count_modes({.lambda = {1.0, 2.0, 4.0, 7.0, 11.0}, .eta2 = tiny, .n_zero = 0}, below);
  EXPECT_EQ(whole.range.missing(), 0);
  EXPECT_EQ(whole.bounds.size(), 5u);
  const auto gapped =
      count_modes({.lambda = {1.0, 2.0, 4.0, 11.0, 16.0}, .eta2 = tiny, .n_zero = 0}, below);
  EXPECT_EQ(gapped.range.expected, 6);
  EXPECT_EQ(gapped.range.missing(), 1);
  EXPECT_EQ(gapped.complete.missing(), 0);
  EXPECT_GT(gapped.complete.sigma, 1.0);
  EXPECT_LT(gapped.complete.sigma, 7.0);
}

TEST(CountModes, CountsRigidMotionsAsFound)
{
  const auto all = count_modes({.lambda = {1.0}, .eta2 = {1e-8}, .n_zero = 6},
                               [](double sigma) { return sigma > 1.0 ? 7 : 6; });
  EXPECT_EQ(all.range.missing(), 0);
}

}  // namespace
}  // namespace chladni::reduce
