// Eigenvalues of any multiplicity: block Lanczos beside spectra that are known.
#include "linear/lanczos/block_iteration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

#include "common/petsc.hpp"
#include "linear/cholesky/factorization.hpp"
#include "linear/lanczos/block_lanczos.hpp"
#include "pencils.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::diagonal, linear::testing::matrix;

petsc::Matrix identity(PetscInt n)
{
  return diagonal(n, [](PetscInt) { return 1.0; });
}

constexpr PetscInt blade_size = 20;

/// Chains of `blade_size` unit masses between fixed ends, not coupled.
petsc::Matrix blades(PetscInt n_blades)
{
  return matrix(n_blades * blade_size, 3, [](PetscInt i) {
    std::vector<std::pair<PetscInt, double>> row{{i, 2.0}};
    if (i % blade_size > 0) row.emplace_back(i - 1, -1.0);
    if (i % blade_size < blade_size - 1) row.emplace_back(i + 1, -1.0);
    return row;
  });
}

double blade_lambda(PetscInt k)
{
  return 4.0 * std::pow(std::sin(0.5 * (k + 1) * std::numbers::pi / (blade_size + 1)), 2);
}

/// The Laplacian of the hypercube with d dimensions: eigenvalues 2 k with multiplicity binom(d, k).
petsc::Matrix hypercube(int d, double shift)
{
  return matrix(PetscInt(1) << d, d + 1, [=](PetscInt i) {
    std::vector<std::pair<PetscInt, double>> row{{i, d + shift}};
    for (int bit = 0; bit < d; ++bit) row.emplace_back(i ^ (PetscInt(1) << bit), -1.0);
    return row;
  });
}

std::vector<double> hypercube_spectrum(int d, double shift)
{
  std::vector<double> lambda;
  for (unsigned i = 0; i < 1u << d; ++i) lambda.push_back(2.0 * std::popcount(i) + shift);
  std::ranges::sort(lambda);
  return lambda;
}

/// Values, residuals by the matrices, and orthonormality. Errors of the values are the squares of
/// residuals of 1e-9, and round-off of well-conditioned K.
void expect_multiple_pairs(Mat K, Mat M, const linear::EigenPairs& pairs,
                           const std::vector<double>& exact, double allowed = 1e-11)
{
  ASSERT_GE(pairs.lambda.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i)
    ASSERT_NEAR(pairs.lambda[i], exact[i], allowed * exact[i]) << "pair " << i + 1;
  petsc::Matrix KX, MX;
  petsc::check(MatMatMult(K, pairs.X, MAT_INITIAL_MATRIX, petsc::automatic, KX.put()));
  petsc::check(MatMatMult(M, pairs.X, MAT_INITIAL_MATRIX, petsc::automatic, MX.put()));
  const Eigen::MatrixXd I = linear::inner_product(pairs.X, MX);
  for (PetscInt i = 0; i < I.rows(); ++i)
    for (PetscInt j = 0; j < I.cols(); ++j) ASSERT_NEAR(I(i, j), i == j ? 1.0 : 0.0, 1e-12);
  petsc::Vector lambda;
  petsc::check(MatCreateVecs(MX, lambda.put(), nullptr));
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(lambda, &first, &last));
  for (PetscInt i = first; i < last; ++i)
    petsc::check(VecSetValue(lambda, i, pairs.lambda[i], INSERT_VALUES));
  petsc::check(VecAssemblyBegin(lambda));
  petsc::check(VecAssemblyEnd(lambda));
  petsc::check(MatDiagonalScale(MX, nullptr, lambda));
  petsc::check(MatAXPY(KX, -1.0, MX, SAME_NONZERO_PATTERN));
  PetscReal residual = 0.0, size = 0.0;
  petsc::check(MatNorm(KX, NORM_FROBENIUS, &residual));
  petsc::check(MatNorm(MX, NORM_FROBENIUS, &size));
  EXPECT_LT(residual, 1e-7 * size);
}

void expect_lowest(Mat K, Mat M, const std::vector<double>& exact, double allowed = 1e-11)
{
  const linear::Factorization factor(K);
  const auto n = static_cast<PetscInt>(exact.size());
  expect_multiple_pairs(K, M, linear::block_lanczos(factor.factor(), M, {.n_pairs = n}), exact,
                        allowed);
}

std::vector<double> blade_spectrum(PetscInt n_blades, PetscInt n)
{
  std::vector<double> lambda;
  for (PetscInt i = 0; i < n; ++i) lambda.push_back(blade_lambda(i / n_blades));
  return lambda;
}

TEST(Multiplicity, OfIdenticalBladesIsTheirNumber)
{
  for (const PetscInt n_blades : {8, 9, 36, 50}) {
    const petsc::Matrix K = blades(n_blades), M = identity(n_blades * blade_size);
    SCOPED_TRACE(n_blades);
    for (const PetscInt n : {n_blades / 2, n_blades, 2 * n_blades, 2 * n_blades + 3}) {
      SCOPED_TRACE(n);
      expect_lowest(K, M, blade_spectrum(n_blades, n));
    }
  }
}

TEST(Multiplicity, LeavesVectorsOrthonormalWhereTheSpaceEnds)
{
  // 36 chains of four masses: a Krylov space closes after four steps, with blocks of round-off.
  constexpr PetscInt n = 144;
  const petsc::Matrix K = matrix(n, 3, [](PetscInt i) {
    const auto spring = [](PetscInt k) { return k < 5 ? 100.0 / double(k) : 0.0; };
    const PetscInt k = i % 4 + 1;
    std::vector<std::pair<PetscInt, double>> row{{i, spring(k) + spring(k + 1)}};
    if (k > 1) row.emplace_back(i - 1, -spring(k));
    if (k < 4) row.emplace_back(i + 1, -spring(k + 1));
    return row;
  });
  const petsc::Matrix M = diagonal(n, [](PetscInt i) { return 1.25 + 0.25 * double(i % 4); });
  const linear::Factorization factor(K);
  for (const PetscInt n_pairs : {40, 80, 144}) {
    const linear::EigenPairs pairs =
        linear::block_lanczos(factor.factor(), M, {.n_pairs = n_pairs, .tolerance = 1e-7});
    expect_multiple_pairs(K, M, pairs, pairs.lambda);
  }
}

TEST(Multiplicity, OfTwoHundredIsFound)
{
  const petsc::Matrix K = blades(200), M = identity(200 * blade_size);
  expect_lowest(K, M, blade_spectrum(200, 210));
}

TEST(Multiplicity, OfTheIdentityIsItsSize)
{
  for (const PetscInt n : {5, 30, 200}) {
    const petsc::Matrix I = identity(n);
    for (const PetscInt n_wanted : {std::min<PetscInt>(n, 20), n}) {
      SCOPED_TRACE(n_wanted);
      expect_lowest(I, I, std::vector<double>(n_wanted, 1.0));
    }
  }
}

TEST(Multiplicity, OfTheHypercubeIsBinomial)
{
  std::vector<double> exact = hypercube_spectrum(10, 0.5);
  exact.resize(40);
  expect_lowest(hypercube(10, 0.5), identity(1024), exact);
}

TEST(Multiplicity, IsSeenThroughSpacingsOfRoundOff)
{
  const auto value = [](PetscInt i) { return 1.0 + i / 50 + 1e-12 * (i % 50); };
  std::vector<double> exact;
  for (PetscInt i = 0; i < 120; ++i) exact.push_back(value(i));
  constexpr double cluster_width = 1e-10;  // within it vectors of residual 1e-9 are mixed
  for (const PetscInt n : {20, 50, 60, 120}) {
    const std::vector<double> lowest(exact.begin(), exact.begin() + n);
    expect_lowest(diagonal(1000, value), identity(1000), lowest, cluster_width);
  }
}

TEST(Multiplicity, GrowsWithWhatIsAskedFor)
{
  const petsc::Matrix K = blades(36), M = identity(36 * blade_size);
  const linear::Factorization factor(K);
  for (const PetscInt subspace : {0, 60}) {
    linear::BlockLanczos lanczos(factor.factor(), M, {.n_pairs = 0, .max_subspace = subspace});
    for (const PetscInt n : {4, 36, 38, 72, 80, 150}) {
      lanczos.converge(n);
      ASSERT_EQ(lanczos.n_pairs(), n);
      for (PetscInt i = 0; i < n; ++i)
        ASSERT_NEAR(lanczos.lambda(i) / blade_lambda(i / 36), 1.0, 1e-11) << i << " of " << n;
    }
  }
}

TEST(Multiplicity, OfTheLastModeIsCompleteByNumberAndBelowAFrequency)
{
  const petsc::Matrix K = blades(36), M = identity(36 * blade_size);
  const linear::Factorization factor(K);
  const auto n_modes = [&](const ReduceOptions& wanted) {
    return std::ssize(fixed_interface_modes(factor, M, wanted).omega);
  };
  EXPECT_EQ(n_modes({.modes = 10}), 36);
  EXPECT_EQ(n_modes({.modes = 36}), 36);
  EXPECT_EQ(n_modes({.modes = 72}), 72);
  EXPECT_EQ(n_modes({.modes = 73}), 108);
  const auto between_Hz = [](PetscInt k) {
    return 0.5 * (std::sqrt(blade_lambda(k)) + std::sqrt(blade_lambda(k + 1))) /
           (2.0 * std::numbers::pi);
  };
  EXPECT_EQ(n_modes({.cutoff_Hz = between_Hz(0)}), 36);
  EXPECT_EQ(n_modes({.cutoff_Hz = between_Hz(2)}), 108);
}

TEST(Multiplicity, OfZeroedRowsIsTheirNumber)
{
  // What MatZeroRowsColumns(..., 1.0) leaves of supports, beside a chain.
  constexpr PetscInt n = 400, n_supports = 74;
  const petsc::Matrix K = matrix(n, 3, [](PetscInt i) {
    std::vector<std::pair<PetscInt, double>> row{{i, i < n_supports ? 1.0 : 2.0e4}};
    if (i > n_supports) row.emplace_back(i - 1, -1.0e4);
    if (i >= n_supports && i < n - 1) row.emplace_back(i + 1, -1.0e4);
    return row;
  });
  std::vector<double> exact(n_supports, 1.0);
  for (PetscInt k = 1; k <= n - n_supports; ++k)
    exact.push_back(4e4 * std::pow(std::sin(0.5 * k * std::numbers::pi / (n - n_supports + 1)), 2));
  std::ranges::sort(exact);
  for (const PetscInt n_wanted : {30, 90})
    expect_lowest(K, identity(n), {exact.begin(), exact.begin() + n_wanted});
}

TEST(Multiplicity, OfOneDoesNotHideBehindAMassOf1e12)
{
  const petsc::Matrix K = blades(5);
  const petsc::Matrix M = diagonal(5 * blade_size, [](PetscInt i) { return i == 7 ? 1e12 : 1.0; });
  const linear::Factorization factor(K);
  const linear::EigenPairs pairs = linear::block_lanczos(factor.factor(), M, {.n_pairs = 13});
  ASSERT_EQ(pairs.lambda.size(), 13u);
  // The heavy mass on springs of 7 and 13 others in a row; for all others it stands still.
  EXPECT_NEAR(pairs.lambda[0], (1.0 / 8.0 + 1.0 / 13.0) * 1e-12, 1e-20);
  std::vector<double> exact;
  const auto chain = [](int k, int n) {
    return 4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / (n + 1)), 2);
  };
  for (int k = 1; k <= 7; ++k) exact.push_back(chain(k, 7));
  for (int k = 1; k <= 12; ++k) exact.push_back(chain(k, 12));
  for (int k = 1; k <= 20; ++k) exact.insert(exact.end(), 4, chain(k, 20));
  std::ranges::sort(exact);
  for (std::size_t i = 1; i < 13; ++i) EXPECT_NEAR(pairs.lambda[i] / exact[i - 1], 1.0, 1e-10);
}

TEST(Multiplicity, EndsWithTheRankOfAConsistentMass)
{
  // M of pairs of DOFs that move together: [1 1; 1 1] has rank one, and round-off in other bases.
  constexpr PetscInt n = 60;
  const petsc::Matrix K = diagonal(n, [](PetscInt i) { return 1.0 + 0.37 * i; });
  const double c = std::cos(0.3), s = std::sin(0.3);
  const petsc::Matrix M = matrix(n, 2, [&](PetscInt i) {
    const PetscInt partner = i ^ 1;
    const double own = i % 2 == 0 ? c * c : s * s;
    return std::vector{std::pair{i, own}, std::pair{partner, c * s}};
  });
  std::vector<double> exact;
  for (PetscInt i = 0; i < n; i += 2)
    exact.push_back(1.0 / (c * c / (1.0 + 0.37 * i) + s * s / (1.0 + 0.37 * (i + 1))));
  const linear::Factorization factor(K);
  const linear::EigenPairs pairs = linear::block_lanczos(factor.factor(), M, {.n_pairs = n});
  EXPECT_EQ(pairs.lambda.size(), exact.size());
  expect_multiple_pairs(K, M, pairs, exact);
}

TEST(CopiesAmong, AsksForMoreThanTheSequenceCanHold)
{
  const linear::RitzValues pairs{.theta = {3.0, 2.0, 2.0, 1.0, 1.0},
                                 .residual = std::vector(5, 0.0)};
  EXPECT_EQ(linear::copies_among(pairs, 5, {.n_sources = 2}, 1e-7),
            linear::Copies::may_lack);  // of 2.0
  EXPECT_EQ(linear::copies_among(pairs, 5, {.n_sources = 3}, 1e-7), linear::Copies::all_there);
  EXPECT_EQ(linear::copies_among(pairs, 3, {.n_sources = 2}, 1e-7),
            linear::Copies::all_there);  // the last one
  const linear::KrylovSequence second{.n_sources = 2, .known = {3.0, 2.0, 2.0}};
  EXPECT_EQ(linear::copies_among(pairs, 4, second, 1e-7), linear::Copies::all_there);
}

TEST(CopiesAmong, WaitsForTheLargestOfANewSequence)
{
  linear::RitzValues pairs{.theta = {3.0, 2.0, 1.0}, .residual = {0.0, 0.0, 0.1}};
  const linear::KrylovSequence second{.n_sources = 2, .known = {3.0, 2.0}};
  EXPECT_EQ(linear::copies_among(pairs, 2, second, 1e-7), linear::Copies::not_yet_known);
  pairs.residual[2] = 1e-5;
  EXPECT_EQ(linear::copies_among(pairs, 2, second, 1e-7), linear::Copies::all_there);
}

/// A small rigid body that is described far from itself: the mass of one of its two motions is d.
/// lambda = 0.5 and 2.
testing::ElementPencil pair_with_hardly_any_mass(double d)
{
  testing::ElementPencil element{
      .dofs = {0, 1}, .K = Eigen::MatrixXd(2, 2), .M = Eigen::MatrixXd(2, 2)};
  element.K << 0.5 + d, 0.5 - d, 0.5 - d, 0.5 + d;
  element.M << 1.0, 1.0 - d, 1.0 - d, 1.0;
  return element;
}

TEST(Multiplicity, OfAPairWithHardlyAnyMassIsNotMissedInSilence)
{
  // Of d = 1e-8 the products with M leave eight digits, of d = 1e-10 six: less than a residual of
  // 1e-9 asks for.
  for (const double d : {1e-8, 1e-10}) {
    const linear::testing::Chain pencil = testing::assemble(2, {pair_with_hardly_any_mass(d)});
    const linear::Factorization factor = linear::factorize(pencil.K);
    linear::BlockLanczos lanczos(factor.factor(), pencil.M, {.n_pairs = 0});
    lanczos.converge(2);
    if (lanczos.n_pairs() > 0) {
      EXPECT_NEAR(lanczos.lambda(0), 0.5, 1e-8);
    }
    EXPECT_NO_THROW(lanczos.require_resolved(0.49));
    if (d == 1e-8) continue;
    ASSERT_LT(lanczos.n_pairs(), 2);
    EXPECT_LT(lanczos.unresolved_from(), 2.1);
    EXPECT_THROW(lanczos.require_resolved(2.1), Error);
    EXPECT_THROW(linear::block_lanczos(factor.factor(), pencil.M, {.n_pairs = 2}), Error);
  }
}

/// Such a pair beside a chain of 30 masses on springs of 4 N/m: lambda = 5 and 20 cannot be
/// resolved, all of the chain can.
TEST(FixedInterfaceModes, BelowACutoffAreRefusedWhereOneOfThemMayBeMissing)
{
  constexpr PetscInt n_chain = 30;
  testing::ElementPencil pair = pair_with_hardly_any_mass(1e-10);
  pair.K *= 10.0;
  pair.dofs = {n_chain, n_chain + 1};
  testing::ElementPencil chain{.dofs = {},
                               .K = Eigen::MatrixXd::Zero(n_chain, n_chain),
                               .M = Eigen::MatrixXd::Identity(n_chain, n_chain)};
  for (PetscInt i = 0; i < n_chain; ++i) {
    chain.dofs.push_back(i);
    chain.K(i, i) = 8.0;
    if (i > 0) chain.K(i, i - 1) = chain.K(i - 1, i) = -4.0;
  }
  const linear::testing::Chain pencil = testing::assemble(n_chain + 2, {chain, pair});
  const linear::Factorization K = linear::factorize(pencil.K);
  const auto below = [&](double omega) {
    return fixed_interface_modes(K, pencil.M, {.cutoff_Hz = omega / (2.0 * std::numbers::pi)});
  };
  // omega = 4 sin(k pi / 62)
  EXPECT_EQ(below(1.5).omega.size(), 7u);
  EXPECT_THROW(below(3.0), Error);  // omega^2 = 9 lies above 5, and omega below it
  EXPECT_THROW(below(10.0), Error);
}

}  // namespace
}  // namespace chladni::reduce
