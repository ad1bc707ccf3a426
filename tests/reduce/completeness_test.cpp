#include "reduce/completeness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "linear/cholesky/factorization.hpp"
#include "linear/cholesky/sylvester.hpp"
#include "linear/dense/dense_solvers.hpp"
#include "reduce/partition.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

constexpr PetscInt n_of_free_chain = 40;  // masses

/// Eigenvalue k = 0, 1, ... of the free chain.
double free_eigenvalue(int k)
{
  return std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / n_of_free_chain), 2);
}

TEST(EigenvaluesBelow, CountsThoseOfTheFreeChain)
{
  const linear::testing::Chain chain = linear::testing::free_chain(n_of_free_chain);
  for (const int k : {1, 7, 39}) {
    const double sigma = 0.5 * (free_eigenvalue(k - 1) + free_eigenvalue(k));
    for (const double gap : {0.0, 3e-5})  // by MUMPS, and without pivoting
      EXPECT_EQ(linear::eigenvalues_below(chain.K, chain.M, {sigma, gap}), k);
  }
  EXPECT_EQ(linear::eigenvalues_below(chain.K, chain.M, {5.0, 3e-5}),
            n_of_free_chain);  // all are below 4
}

TEST(EigenvaluesBelow, CountsWithoutTheHeldDofs)
{
  const linear::testing::Chain chain = linear::testing::free_chain(n_of_free_chain);
  const auto held_eigenvalue = [](int k) {  // n - 2 masses between fixed ends
    return std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / (n_of_free_chain - 1)), 2);
  };
  const double sigma = 0.5 * (held_eigenvalue(9) + held_eigenvalue(10));
  EXPECT_EQ(linear::eigenvalues_below(chain.K, chain.M, {sigma, 3e-5},
                                      {.held = {n_of_free_chain - 1, 0}}),
            9);
}

TEST(EigenvaluesBelow, TakeOverTheEliminationOfAFactorAndLeaveItAsItIs)
{
  const linear::testing::Chain chain = linear::testing::free_chain(n_of_free_chain);
  const auto fixed_eigenvalue = [](int n_masses, int k) {  // between fixed ends
    return std::pow(2.0 * std::sin(0.5 * k * std::numbers::pi / (n_masses + 1)), 2);
  };
  constexpr int middle = 12;
  const DofPartition dofs =
      partition(chain.K, linear::testing::master_set(chain.K, {0, middle, n_of_free_chain - 1}));
  const Blocks K = split(chain.K, dofs), M = split(chain.M, dofs);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  const double condition = linear::condition_estimate(K_ss);
  const double sigma =
      0.5 * (fixed_eigenvalue(n_of_free_chain - 2, 9) + fixed_eigenvalue(n_of_free_chain - 2, 10));
  EXPECT_EQ(linear::eigenvalues_below(chain.K, chain.M, {sigma, 3e-5},
                                      {.held = {n_of_free_chain - 1, 0},
                                       .factor = K_ss.factor(),
                                       .factored = all_slaves(dofs)}),
            9);
  int n_below = 0;
  for (const int n_masses : {middle - 1, n_of_free_chain - middle - 2})
    for (int k = 1; k <= n_masses; ++k) n_below += fixed_eigenvalue(n_masses, k) < sigma ? 1 : 0;
  EXPECT_EQ(linear::eigenvalues_below(K.ss, M.ss, {sigma, 3e-5}, {.factor = K_ss.factor()}),
            n_below);
  EXPECT_EQ(linear::condition_estimate(K_ss), condition);
}

TEST(EigenvaluesBelow, AreCountedWherePivotsVanishOrNearlySo)
{
  // The first pivots are 2 - sigma; of 2 - 2 cos(k pi / 801) those up to k = 400 are below.
  const linear::testing::Chain chain = linear::testing::free_chain(801);
  for (const double sigma : {2.0 - 1e-12, 2.0 - 1e-15, 2.0, 2.0 + 1e-9, 2.0 + 1e-5})
    EXPECT_EQ(linear::eigenvalues_below(chain.K, chain.M, {sigma, 3e-5}), 401) << sigma;
}

TEST(ConditionEstimate, IsExactForTheChainBetweenFixedEnds)
{
  const linear::testing::Chain chain = linear::testing::free_chain(n_of_free_chain + 1);
  const DofPartition dofs =
      partition(chain.K, linear::testing::master_set(chain.K, {0, n_of_free_chain}));
  const Blocks K = split(chain.K, dofs);
  // |K|_1 = 4; column j of the inverse sums to j (m + 1 - j) / 2, at most (m + 1)^2 / 8, m = n - 1.
  EXPECT_NEAR(linear::condition_estimate(linear::factorize(K.ss)),
              4.0 * n_of_free_chain * n_of_free_chain / 8.0,
              1e-9 * n_of_free_chain * n_of_free_chain);  // round-off
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

/// [1 x 1], or diagonal.
Eigen::MatrixXd diagonal_matrix(const std::vector<double>& values)
{
  const auto k = static_cast<PetscInt>(values.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(k, k);
  for (PetscInt i = 0; i < k; ++i) A(i, i) = values[static_cast<std::size_t>(i)];
  return A;
}

TEST(ErrorBounds, AreSharpWhereTheNextEigenvalueIsKnown)
{
  const TwoByTwo pencil{.angle = 0.1};
  const auto bounds = error_bounds({pencil.ritz()}, diagonal_matrix({pencil.eta2()}), 10.0);
  // Temple's inequality is an equation for a vector out of two eigenvectors; rounding comes on top.
  EXPECT_GE(bounds[0], pencil.ritz() - 1.0);
  EXPECT_NEAR(bounds[0], pencil.ritz() - 1.0, 1e-14);
}

/// The exact eigenvalues of diag(lambda), M = I, their Ritz values in a basis, and the bounds.
struct Leaning {
  Eigen::VectorXd exact, ritz;
  std::vector<double> bounds;
};

Leaning leaning(const Eigen::VectorXd& exact, const Eigen::MatrixXd& basis, double sigma)
{
  using Eigen::MatrixXd;
  const Eigen::MatrixXd K = exact.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      basis.transpose() * K * basis, basis.transpose() * basis);
  const Eigen::MatrixXd U = basis * eigen.eigenvectors();
  const Eigen::VectorXd lambda = eigen.eigenvalues();
  const Eigen::MatrixXd R = K * U - U * lambda.asDiagonal();
  const Eigen::MatrixXd scale = lambda.cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd K_inverse = exact.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd H = scale * R.transpose() * K_inverse * R * scale;
  return {exact, lambda, error_bounds({lambda.begin(), lambda.end()}, H, sigma)};
}

TEST(ErrorBounds, OfTwoCloseValuesHoldForBoth)
{
  Eigen::MatrixXd apart(4, 2), together(4, 2);  // towards two far eigenvalues, and towards one
  apart << 1.0, 0.0, 0.0, 1.0, 0.02, 0.0, 0.0, 0.015;
  together << 1.0, 0.0, 0.0, 1.0, 0.02, 0.015, 0.0, 0.0;
  const Eigen::Vector4d exact(1.0, 1.0001, 10.0, 10.0);
  for (const auto& [basis, most] : {std::pair{apart, 1.05}, {together, 2.0}}) {
    const Leaning of = leaning(exact, basis, 9.0);
    for (int i = 0; i < 2; ++i) {
      const double error = of.ritz[i] / exact[i] - 1.0;
      EXPECT_GE(of.bounds[i], error);
      EXPECT_LE(of.bounds[i], most * error) << i;
    }
  }
}

/// All of fifty values are a little off: none of the residuals spoils the bounds of the others.
TEST(ErrorBounds, OfManyValuesAreSharpInTheGapThatWasCounted)
{
  constexpr int k = 50;
  Eigen::VectorXd exact(2 * k);
  for (int i = 0; i < 2 * k; ++i) exact[i] = (i + 1.0) * (i + 1.0);
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(2 * k, k);
  for (int i = 0; i < k; ++i) {
    basis(i, i) = 1.0;
    basis(i + k, i) = 1e-3;
  }
  const Leaning of = leaning(exact, basis, 0.5 * (exact[k - 1] + exact[k]));
  for (int i = 0; i < k; ++i) {
    const double error = of.ritz[i] / exact[i] - 1.0;
    EXPECT_GE(of.bounds[i], error) << i;
  }
  for (int i = 0; i < k - 10; ++i)
    EXPECT_LE(of.bounds[i], 3.0 * (of.ritz[i] / exact[i] - 1.0)) << i;
}

TEST(ErrorBounds, KeepTheirDigitsOverTwentyFourDecades)
{
  const std::vector<double> lambda{1e-12, 1.0, 1e6, 1e12};
  for (const double bound :
       error_bounds(lambda, diagonal_matrix({1e-14, 1e-14, 1e-14, 1e-14}), 2e12))
    EXPECT_LE(bound, 4e-14);
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
  EXPECT_GE(error_bounds({lambda}, diagonal_matrix({eta2}), 1.01 * lambda)[0],
            lambda / exact - 1.0);
}

TEST(CountModes, RefusesACountBelowWhatIsThereAndSaysWhatToLookFor)
{
  try {
    count_modes({.lambda = {1.0, 2.0},
                 .residuals = diagonal_matrix({1e-8, 1e-8}),
                 .n_zero = 0,
                 .comm = PETSC_COMM_SELF},
                [](double) { return 1; });
    FAIL() << "a projection cannot have more eigenvalues";
  } catch (const Error& error) {
    const std::string text = error.what();
    for (const char* word : {"1 counted below 0.22", "has 2", "nothing holds", "sylvester = false"})
      EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
    EXPECT_EQ(text.find("internal"), std::string::npos) << text;
  }
}

TEST(CountModes, FindsTheModeThatIsMissing)
{
  const std::vector<double> full = {1.0, 2.0, 4.0, 7.0, 11.0, 16.0, 22.0};
  const auto below = [&](double sigma) {
    return static_cast<int>(std::ranges::lower_bound(full, sigma) - full.begin());
  };
  const Eigen::MatrixXd tiny = diagonal_matrix(std::vector<double>(5, 1e-8));
  const auto whole = count_modes({.lambda = {1.0, 2.0, 4.0, 7.0, 11.0},
                                  .residuals = tiny,
                                  .n_zero = 0,
                                  .comm = PETSC_COMM_SELF},
                                 below);
  EXPECT_EQ(whole.range.missing(), 0);
  EXPECT_EQ(whole.bounds.size(), 5u);
  const auto gapped = count_modes({.lambda = {1.0, 2.0, 4.0, 11.0, 16.0},
                                   .residuals = tiny,
                                   .n_zero = 0,
                                   .comm = PETSC_COMM_SELF},
                                  below);
  EXPECT_EQ(gapped.range.expected, 6);
  EXPECT_EQ(gapped.range.missing(), 1);
  EXPECT_EQ(gapped.complete.missing(), 0);
  EXPECT_GT(gapped.complete.sigma, 1.0);
  EXPECT_LT(gapped.complete.sigma, 7.0);
}

TEST(CountModes, BoundsTheFirstValuesByACountBelowTheOneThatIsBadlyFound)
{
  // The sixth value, whose residual is large, might as well be any of those before it, unless the
  // three below the widest gap are known to be all that there are.
  const std::vector<double> full = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 20.0};
  const auto found =
      count_modes({.lambda = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0},
                   .residuals = diagonal_matrix({1e-8, 1e-8, 1e-8, 1e-8, 1e-8, 0.2}),
                   .n_zero = 0,
                   .comm = PETSC_COMM_SELF},
                  [&](double sigma) {
                    return static_cast<int>(std::ranges::lower_bound(full, sigma) - full.begin());
                  });
  EXPECT_EQ(found.complete.expected, 6);
  ASSERT_EQ(found.bounds.size(), 6u);
  // Between 3 and what 4 may be at least, 4 / (1 + 1e-4).
  const double sigma = std::sqrt(12.0 / (1.0 + 1e-4));
  for (int i = 0; i < 3; ++i) {
    const double temple = 1e-8 / (1.0 - (i + 1.0) / sigma);
    EXPECT_NEAR(found.bounds[std::size_t(i)], temple, 1e-4 * temple) << i;
  }
  EXPECT_GT(found.bounds[5], 0.2);
}

TEST(CountModes, CountsRigidMotionsAsFound)
{
  const auto all = count_modes(
      {.lambda = {1.0}, .residuals = diagonal_matrix({1e-8}), .n_zero = 6, .comm = PETSC_COMM_SELF},
      [](double sigma) { return sigma > 1.0 ? 7 : 6; });
  EXPECT_EQ(all.range.missing(), 0);
}

}  // namespace
}  // namespace chladni::reduce
