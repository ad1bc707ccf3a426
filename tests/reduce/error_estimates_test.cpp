#include "reduce/error_estimates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "linear/dense/dense_solvers.hpp"
#include "pencils.hpp"
#include "reduce/partition.hpp"
#include "reduce/tolerance_search.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using Eigen::MatrixXd;
using linear::testing::free_chain;
using linear::testing::master_set;

constexpr PetscInt n_estimated = 60;

/// The first pairs of a reduced pencil without its first coordinate.
ReducedPairs lowest(const ReducedModel& model, PetscInt n_pairs)
{
  const Eigen::Index n_r = model.K.rows();
  const auto held = [&](const MatrixXd& A) {
    return MatrixXd(A.bottomRightCorner(n_r - 1, n_r - 1));
  };
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(held(model.K), held(model.M));
  ReducedPairs result{.X = MatrixXd::Zero(n_r, n_pairs), .lambda = {}};
  for (PetscInt j = 0; j < n_pairs; ++j) {
    result.lambda.push_back(eigen.eigenvalues()[j]);
    for (PetscInt i = 1; i < n_r; ++i) result.X(i, j) = eigen.eigenvectors()(i - 1, j);
  }
  return result;
}

/// A chain reduced to its ends with a few modes; its first mass is held.
struct HeldChain {
  explicit HeldChain(int n_modes)
      : Q_CB{.Psi = constraint_modes(K_ss, K),
             .modes = fixed_interface_modes(K_ss, M.ss, {.modes = n_modes, .cutoff_Hz = {}})}
  {}
  linear::testing::Chain chain = free_chain(n_estimated);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {0, n_estimated - 1}));
  Blocks K = split(chain.K, dofs);
  Blocks M = split(chain.M, dofs);
  linear::Factorization K_ss = linear::factorize(K.ss);
  CraigBamptonBasis Q_CB;

  Condensation system() const { return {.K_ss = K_ss, .Q_CB = Q_CB, .K = K, .M = M}; }
  ReducedPairs pairs() const { return lowest(project(Q_CB, K, M), Q_CB.n_modes() + 1); }
};

/// lambda_k, k = 1, 2, ..., of m = n - 1 masses, one end held and the other free.
double exact(int k)
{
  return 4.0 *
         std::pow(std::sin((2 * k - 1) * std::numbers::pi / (2.0 * (2 * n_estimated - 1))), 2);
}

double frequency_Hz(int k)
{
  return std::sqrt(exact(k)) / (2.0 * std::numbers::pi);
}

double true_error(const ReducedPairs& pairs, int k)
{
  return pairs.lambda[k] / exact(k + 1) - 1.0;
}

TEST(ErrorEstimates, MatchTheTrueErrorOfAHeldChain)
{
  constexpr int n_modes = 12;
  const HeldChain held(n_modes);
  const ReducedPairs pairs = held.pairs();
  const std::vector<double> eta2 = error_estimates(held.system(), pairs).eta2;
  // The error lies in the fixed-interface modes left out. One of frequency lambda_j contributes
  // 1 / (1 - lambda / lambda_j) of its share in eta^2, at most that of the first one left out.
  const double left_out =
      4.0 * std::pow(std::sin((n_modes + 1) * std::numbers::pi / (2.0 * (n_estimated - 1))), 2);
  for (int k = 1; k < 9; ++k) {
    const double effectivity = eta2[k] / true_error(pairs, k);
    EXPECT_GT(effectivity, 1.0 - pairs.lambda[k] / left_out - 1e-3) << "mode " << k + 1;
    EXPECT_LT(effectivity, 1.0 + 1e-3) << "mode " << k + 1;
  }
}

TEST(ErrorEstimates, EncloseAnEigenvalueOfTheFullChain)
{
  for (const int n_modes : {3, 8, 20}) {
    const HeldChain held(n_modes);
    const ReducedPairs pairs = held.pairs();
    const std::vector<double> eta2 = error_estimates(held.system(), pairs).eta2;
    for (std::size_t i = 0; i < eta2.size(); ++i) {
      double nearest = 1.0;
      for (int k = 1; k < n_estimated; ++k)
        nearest = std::min(nearest, std::abs(pairs.lambda[i] / exact(k) - 1.0));
      // Round-off of an exact pair: cond(K) eps.
      EXPECT_LE(nearest, std::sqrt(eta2[i]) + 1e-11) << n_modes << " modes, pair " << i + 1;
    }
  }
}

/// Of a motion u of the chain with u_0 = 0 and u^T u = 1, M = I and K_jj = 2, 1 at the free end:
/// 4 eps sum_j (K_jj / lambda + M_jj) u_j^2 = 4 eps ((2 - u_end^2) / lambda + 1).
TEST(ErrorEstimates, HaveTheRoundingOfTheEntriesOfTheChain)
{
  constexpr double eps = std::numeric_limits<double>::epsilon();
  for (const int n_modes : {3, 8, 20}) {
    const HeldChain held(n_modes);
    const ReducedPairs pairs = held.pairs();
    const std::vector<double> rounding = error_estimates(held.system(), pairs).rounding;
    for (std::size_t i = 0; i < rounding.size(); ++i) {
      const double u_end = pairs.X(1, Eigen::Index(i));
      const double of_entries = 4.0 * eps * ((2.0 - u_end * u_end) / pairs.lambda[i] + 1.0);
      EXPECT_GE(rounding[i], of_entries * (1.0 - 1e-6)) << n_modes << " modes, pair " << i + 1;
      // A Galerkin solution has the Rayleigh quotient of its motion. Dense eigenvalues differ from
      // it by 4 eps / lambda, of which the second term is twice.
      EXPECT_LE(rounding[i], of_entries + 16.0 * eps / pairs.lambda[i] + 1e-13)
          << n_modes << " modes, pair " << i + 1;
    }
  }
}

/// What an eigen-solver leaves is measured against the Rayleigh quotient in the FE model, whichever
/// of the masters move.
TEST(ErrorEstimates, CountTheDistanceFromTheRayleighQuotient)
{
  const HeldChain held(8);
  ReducedPairs pairs = held.pairs();
  const std::vector<double> exact = error_estimates(held.system(), pairs).rounding;
  constexpr double off = 1e-5;
  for (double& lambda : pairs.lambda) lambda *= 1.0 + off;
  const std::vector<double> spoiled = error_estimates(held.system(), pairs).rounding;
  for (std::size_t i = 0; i < exact.size(); ++i)
    EXPECT_NEAR(spoiled[i] - exact[i], 2.0 * off, 1e-3 * off) << i;
}

/// A master (k, m) and a left-out mode (lambda_o, 1) coupled by p: eta^2 = p^2 lambda / (m
/// lambda_o), and (k - lambda m) (lambda_o - lambda) = (lambda p)^2 for the exact lambda.
struct LeftOutMode {
  double lambda, lambda_left_out, p;

  double eta2() const { return p * p * lambda / lambda_left_out; }
  /// Of m = 1, k = lambda: the lower root of (1 - p^2) x^2 - (lambda + lambda_o) x + lambda
  /// lambda_o.
  double exact() const
  {
    const double b = lambda + lambda_left_out, c = lambda * lambda_left_out;
    return 2.0 * c / (b + std::sqrt(b * b - 4.0 * (1.0 - p * p) * c));
  }
  double frequency_error() const { return std::sqrt(lambda / exact()) - 1.0; }
};

TEST(FrequencyError, IsThatOfAMasterWithASingleModeLeftOut)
{
  for (const double lambda : {0.1, 2.0, 5.0, 8.0}) {
    const LeftOutMode model{.lambda = lambda, .lambda_left_out = 10.0, .p = 1e-3};
    // To first order in p^2; the next terms are p^2 / (1 - lambda / lambda_o)^2 of it.
    EXPECT_NEAR(frequency_error(model.eta2(), lambda, 10.0) / model.frequency_error(), 1.0, 1e-4)
        << lambda;
  }
}

TEST(FrequencyError, GrowsToFiftyTimesTheHalfOfEtaSquaredAndNoFurther)
{
  EXPECT_DOUBLE_EQ(frequency_error(1e-4, 9.8, 10.0), 0.5e-4 / 0.02);
  for (const double lambda : {9.9, 10.0, 11.0})
    EXPECT_DOUBLE_EQ(frequency_error(1e-4, lambda, 10.0), 0.5e-4 / 0.02);
  EXPECT_DOUBLE_EQ(frequency_error(1e-4, 7.0, std::numeric_limits<double>::infinity()), 0.5e-4);
}

TEST(FrequencyErrorsByPlace, CompareWithTheFrequencyOfThatPlaceWhereTheErrorChangesTheOrder)
{
  // Two bodies side by side: the second frequency is exact, the third one falls below it.
  const LeftOutMode falls{.lambda = 4.01, .lambda_left_out = 20.0, .p = 0.15};
  ASSERT_LT(falls.exact(), 4.0);
  const std::vector<double> lambda{1.0, 4.0, 4.01};
  const std::vector<double> errors =
      frequency_errors_by_place(lambda, {0.0, 0.0, falls.eta2()}, 20.0);
  ASSERT_EQ(errors.size(), 3u);
  const double second_order = std::pow(falls.frequency_error(), 2) * 4.0;
  EXPECT_NEAR(errors[0], 0.0, 1e-15);
  EXPECT_NEAR(errors[1], std::sqrt(4.0 / falls.exact()) - 1.0, second_order);
  EXPECT_NEAR(errors[2], std::sqrt(4.01 / 4.0) - 1.0, 1e-15);
  EXPECT_GT(errors[1], 4.0 * second_order);
}

TEST(FrequencyErrorsByPlace, DoNotSendAModeFarDownWhereTheNextModesAreLeftOut)
{
  // Above half of lambda_left_out the factor 1 / (1 - lambda / lambda_left_out) stays 2.
  for (const double lambda : {5.0, 7.0, 9.99}) {
    const std::vector<double> errors = frequency_errors_by_place({lambda}, {0.3}, 10.0);
    EXPECT_NEAR(errors.front(), 0.3, 1e-15) << lambda;
  }
  EXPECT_NEAR(frequency_errors_by_place({2.5}, {0.3}, 10.0).front(), 0.15 / 0.75, 1e-15);
}

TEST(ErrorEstimates, FallWithTheNumberOfModes)
{
  const HeldChain few(4), many(16);
  EXPECT_GT(error_estimates(few.system(), few.pairs()).eta2[2],
            50.0 * error_estimates(many.system(), many.pairs()).eta2[2]);
}

TEST(GrowingModel, HasTheErrorsOfEveryNumberOfModes)
{
  const HeldChain all(20);
  GrowingModel growing({.K_ss = all.K_ss, .Psi = all.Q_CB.Psi, .K = all.K, .M = all.M});
  const FixedInterfaceModes& modes = *all.Q_CB.modes;
  const auto omega = modes.omega.begin();
  growing.append(linear::ColumnRange(modes.Phi, 0, 8), {omega, omega + 8});
  growing.append(linear::ColumnRange(modes.Phi, 8, 20), {omega + 8, omega + 20});
  for (const int n_modes : {3, 8, 15, 20}) {
    const HeldChain some(n_modes);
    const ReducedModel expected = project(some.Q_CB, some.K, some.M);
    const ReducedModel model = growing.model(n_modes);
    // Signs of modes are free, and with them those of the coupling.
    EXPECT_LT((model.M.cwiseAbs() - expected.M.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((model.K - expected.K).cwiseAbs().maxCoeff(), 1e-9);
    const ReducedPairs pairs = some.pairs();
    const std::vector<double> eta2 = error_estimates(some.system(), pairs).eta2;
    const std::vector<double> grown = growing.error_estimates(pairs, n_modes);
    for (std::size_t i = 0; i < eta2.size(); ++i)
      EXPECT_NEAR(grown[i], eta2[i], 1e-9 * eta2[i] + 1e-12) << n_modes << " modes, pair " << i + 1;
  }
}

TEST(ToleranceSearch, TakesTheFirstNumberOfModesThatKeepsTheTolerance)
{
  const HeldChain held(1);
  const auto lowest_held_pairs = [&](const ReducedModel& model) { return lowest(model, 6); };
  constexpr double tolerance = 1e-6;
  ToleranceSearch search({.K_ss = held.K_ss, .Psi = held.Q_CB.Psi, .K = held.K, .M = held.M},
                         {.tolerance = tolerance, .up_to_Hz = 1.001 * frequency_Hz(6)},
                         lowest_held_pairs);
  do {
    search.find_modes();
  } while (!search.is_enough());
  const int n_modes = static_cast<int>(search.modes().omega.size());
  const auto estimate = [&](int n_estimated) {
    const FixedInterfaceModes next =
        fixed_interface_modes(held.K_ss, held.M.ss, {.modes = n_estimated + 1});
    const CraigBamptonBasis Q_CB{
        .Psi = constraint_modes(held.K_ss, held.K),
        .modes = fixed_interface_modes(held.K_ss, held.M.ss, {.modes = n_estimated})};
    const ReducedPairs pairs = lowest(project(Q_CB, held.K, held.M), 6);
    const std::vector<double> eta2 = error_estimates({held.K_ss, Q_CB, held.K, held.M}, pairs).eta2;
    double largest = 0.0;
    for (std::size_t k = 0; k < eta2.size(); ++k) {
      const double last = Q_CB.modes->omega.back();
      largest = std::max(largest, frequency_error(eta2[k], pairs.lambda[k], last * last));
    }
    return largest;
  };
  EXPECT_LE(estimate(n_modes), 1.001 * tolerance);
  EXPECT_GT(estimate(n_modes - 1), tolerance);
  const CraigBamptonBasis Q_CB{.Psi = constraint_modes(held.K_ss, held.K), .modes = search.modes()};
  const ReducedPairs pairs = lowest(project(Q_CB, held.K, held.M), 6);
  for (int k = 0; k < 6; ++k)
    EXPECT_LT(std::sqrt(1.0 + true_error(pairs, k)) - 1.0, tolerance) << k;
}

/// All modes of the slaves leave round-off: what it is stands beside what was asked, and can be
/// asked for.
TEST(ToleranceSearch, TellsWhatAllModesReach)
{
  const HeldChain held(1);
  const auto all_to = [&](double tolerance) {
    return testing::refused_numbers([&] {
      ToleranceSearch search({.K_ss = held.K_ss, .Psi = held.Q_CB.Psi, .K = held.K, .M = held.M},
                             {.tolerance = tolerance, .up_to_Hz = 1.001 * frequency_Hz(6)},
                             [](const ReducedModel& model) { return lowest(model, 6); });
      do {
        search.find_modes();
      } while (!search.is_enough());
    });
  };
  const std::vector<std::string> numbers = all_to(1e-30);
  if (numbers.empty()) {  // round-off cancels, as on two ranks: nothing is left
    EXPECT_TRUE(all_to(std::numeric_limits<double>::min()).empty());
    return;
  }
  ASSERT_EQ(numbers.size(), 2u);
  const double reached = std::stod(numbers[0]);
  EXPECT_LT(reached, 1e-9);
  const std::vector<std::string> at_the_edge = all_to(reached * (1.0 - 1e-3));
  EXPECT_TRUE(at_the_edge.size() == 2 && at_the_edge[0] != at_the_edge[1]);
  EXPECT_TRUE(all_to(1.1 * reached).empty());
}

/// Modes that the search takes for a tolerance of 0.1 where row 0 is the master.
/// @param end  of the range, rad^2/s^2
std::size_t n_modes_to_a_tenth(const linear::testing::Chain& pencil, double end)
{
  const DofPartition dofs = partition(pencil.K, master_set(pencil.K, {0}));
  const Blocks K = split(pencil.K, dofs), M = split(pencil.M, dofs);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  const petsc::Matrix Psi = constraint_modes(K_ss, K);
  const auto in_range = [&](const ReducedModel& model) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(model.K, model.M);
    const auto k = (eigen.eigenvalues().array() < 1.5 * end).count();
    ReducedPairs pairs{.X = eigen.eigenvectors().leftCols(k), .lambda = {}};
    pairs.lambda.assign(eigen.eigenvalues().begin(), eigen.eigenvalues().begin() + k);
    return pairs;
  };
  ToleranceSearch search({.K_ss = K_ss, .Psi = Psi, .K = K, .M = M},
                         {.tolerance = 0.1, .up_to_Hz = std::sqrt(end) / (2.0 * std::numbers::pi)},
                         in_range);
  do {
    search.find_modes();
  } while (!search.is_enough());
  return search.modes().omega.size();
}

/// A mode above the range that pulls a frequency of the master into it: without the mode that
/// frequency lies far above the range, and has no estimate there.
TEST(ToleranceSearch, LacksNoFrequencyOfTheRange)
{
  testing::ElementPencil element{.dofs = {0, 1, 2}, .K = MatrixXd(3, 3), .M = MatrixXd(3, 3)};
  element.K << 20.0, 0.0, 0.0, 0.0, 7.0, 0.0, 0.0, 0.0, 8.4;
  element.M << 1.0, 0.01, 0.9, 0.01, 1.0, 0.0, 0.9, 0.0, 1.0;  // frequencies^2: 6.19, 7.0, 142
  EXPECT_EQ(n_modes_to_a_tenth(testing::assemble(3, {element}), 8.0), 2u);
}

/// Beside it a mode of slaves alone that lies above the range, but within the tolerance: it is
/// exact, and no counterpart of the frequency that the next mode pulls into the range.
TEST(ToleranceSearch, TakesNoOtherFrequencyForTheOneThatIsMissing)
{
  testing::ElementPencil element{
      .dofs = {0, 1, 2, 3}, .K = MatrixXd::Zero(4, 4), .M = MatrixXd::Identity(4, 4)};
  element.K.diagonal() << 20.0, 7.0, 8.5, 8.8;
  element.M(0, 1) = element.M(1, 0) = 0.01;
  element.M(0, 3) = element.M(3, 0) = 0.9;  // frequencies^2: 6.38, 7.0, 8.5, 145
  const linear::testing::Chain pencil = testing::assemble(4, {element});
  EXPECT_EQ(n_modes_to_a_tenth(pencil, 8.0), 3u);
}

/// Pairs of two chains that nothing couples, of each by turns: they are estimated in blocks of the
/// same chain, and come back in their order.
TEST(ErrorEstimates, OfSeveralPartsAreThoseOfEachPair)
{
  constexpr PetscInt n_all = 60;
  constexpr int n_pairs = 20;
  const auto chains = [](double first, double second, double next) {
    return linear::testing::matrix(n_all, 3, [=](PetscInt i) {
      linear::testing::Row row{{i, i % 2 == 0 ? first : second}};
      if (i > 1) row.emplace_back(i - 2, next);
      if (i + 2 < n_all) row.emplace_back(i + 2, next);
      return row;
    });
  };
  const petsc::Matrix K_all = chains(2.0, 2.3, -1.0), M_all = chains(1.0, 1.5, 0.1);
  const DofPartition dofs = partition(K_all, master_set(K_all, {0, 1}));
  const Blocks K = split(K_all, dofs), M = split(M_all, dofs);
  const linear::Factorization K_ss = linear::factorize(K.ss);
  const CraigBamptonBasis Q_CB{.Psi = constraint_modes(K_ss, K),
                               .modes = fixed_interface_modes(K_ss, M.ss, {.modes = 24})};
  const ReducedModel model = project(Q_CB, K, M);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(model.K, model.M);
  ReducedPairs pairs{.X = eigen.eigenvectors().leftCols(n_pairs), .lambda = {}};
  pairs.X = (pairs.X.array().abs() < 1e-9).select(0.0, pairs.X);  // round-off of the other chain
  pairs.lambda.assign(eigen.eigenvalues().begin(), eigen.eigenvalues().begin() + n_pairs);
  const int n_first = static_cast<int>((pairs.X.row(0).array() != 0.0).count());
  ASSERT_GE(n_first, 8);  // fewer share a block
  ASSERT_LE(n_first, n_pairs - 8);
  const Condensation system{.K_ss = K_ss, .Q_CB = Q_CB, .K = K, .M = M};
  const ErrorEstimates all = error_estimates(system, pairs, Purpose::bounds);
  for (int k = 0; k < n_pairs; ++k) {
    const ErrorEstimates one =
        error_estimates(system, {.X = pairs.X.col(k), .lambda = {pairs.lambda[k]}});
    EXPECT_NEAR(all.eta2[k], one.eta2[0], 1e-12 * one.eta2[0] + 1e-16) << k;
    EXPECT_NEAR(all.rounding[k], one.rounding[0], 1e-13) << k;
    EXPECT_NEAR(all.inner_products(k, k), one.eta2[0], 1e-12 * one.eta2[0] + 1e-16) << k;
    for (int j = 0; j < n_pairs; ++j) {
      const bool is_of_other = (pairs.X(0, j) != 0.0) != (pairs.X(0, k) != 0.0);
      const double least = is_of_other ? 1e-18 : 1.0;
      EXPECT_LT(std::abs(all.inner_products(j, k)), least);
    }
  }
}

TEST(GrowingModel, HasAHeavierModelThatCountsAllEigenvalues)
{
  const HeldChain all(20);
  GrowingModel growing({.K_ss = all.K_ss, .Psi = all.Q_CB.Psi, .K = all.K, .M = all.M});
  const FixedInterfaceModes& modes = *all.Q_CB.modes;
  growing.append(modes.Phi, modes.omega);
  for (const int n_modes : {1, 2, 5, 12, 19}) {
    const double left_out = std::pow(modes.omega[n_modes], 2);
    int sharp = 0, cases = 0;
    for (int k = 1; exact(k) < left_out; ++k) {
      const double sigma = exact(k) * (1.0 + 1e-9);  // the FE model has k below
      if (sigma >= left_out) break;
      const ReducedModel heavier = growing.heavier_model(n_modes, sigma, left_out);
      const std::vector<double> lambda = lowest(heavier, n_modes + 1).lambda;
      const auto below = std::ranges::lower_bound(lambda, sigma) - lambda.begin();
      EXPECT_GE(below, k) << n_modes << " modes";
      sharp += below == k;
      ++cases;
    }
    EXPECT_GE(sharp, cases - 1) << n_modes << " modes";
  }
}

TEST(ToleranceSearch, CountsAFrequencyThatTooFewModesPutBeyondTheRange)
{
  // The fifth frequency lies at the end of the range, and above it as long as modes are missing.
  const HeldChain held(1);
  constexpr double tolerance = 1e-2;
  ToleranceSearch search({.K_ss = held.K_ss, .Psi = held.Q_CB.Psi, .K = held.K, .M = held.M},
                         {.tolerance = tolerance, .up_to_Hz = 1.0005 * frequency_Hz(5)},
                         [](const ReducedModel& model) {
                           return lowest(model,
                                         std::min(6, static_cast<PetscInt>(model.K.rows()) - 1));
                         });
  do {
    search.find_modes();
  } while (!search.is_enough());
  const CraigBamptonBasis Q_CB{.Psi = constraint_modes(held.K_ss, held.K), .modes = search.modes()};
  const ReducedPairs pairs = lowest(project(Q_CB, held.K, held.M), 5);
  for (int k = 0; k < 5; ++k)
    EXPECT_LT(std::sqrt(1.0 + true_error(pairs, k)) - 1.0, tolerance) << k;
}

/// The modes of a model with all its masters held, which are the fixed-interface modes.
ReducedPairs with_held_masters(const ReducedModel& model)
{
  const auto n_modes = static_cast<PetscInt>(model.omega.size());
  ReducedPairs pairs{.X = MatrixXd::Zero(model.K.rows(), n_modes), .lambda = {}};
  for (PetscInt k = 0; k < n_modes; ++k) {
    pairs.X(model.n_masters + k, k) = 1.0;
    pairs.lambda.push_back(model.omega[k] * model.omega[k]);
  }
  return pairs;
}

TEST(ToleranceSearch, TakesAllModesOfTheRangeWhereEveryModeThatItHasIsExact)
{
  const HeldChain held(1);
  constexpr int n_in_range = 53;               // more than a search begins with
  const auto fixed_frequency_Hz = [](int k) {  // n - 2 masses between fixed ends
    return std::sin(0.5 * k * std::numbers::pi / (n_estimated - 1)) / std::numbers::pi;
  };
  for (const int n_wanted : {19, n_in_range}) {
    const double between = 0.5 * (fixed_frequency_Hz(n_wanted) + fixed_frequency_Hz(n_wanted + 1));
    ToleranceSearch search({.K_ss = held.K_ss, .Psi = held.Q_CB.Psi, .K = held.K, .M = held.M},
                           {.tolerance = 1e-3, .up_to_Hz = between}, with_held_masters);
    do {
      search.find_modes();
    } while (!search.is_enough());
    EXPECT_EQ(search.modes().omega.size(), static_cast<std::size_t>(n_wanted));
  }
}

}  // namespace
}  // namespace chladni::reduce
