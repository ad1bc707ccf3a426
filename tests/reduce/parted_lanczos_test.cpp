#include "linear/lanczos/parted_lanczos.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "linear/cholesky/part_solver.hpp"
#include "linear/kernels/decoupled_rows.hpp"
#include "reduce/fixed_interface_modes.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

/// Chains of n masses between fixed ends, of several stiffnesses, that lie into each other. Masses
/// are one, but zero in chains without.
struct Chains {
  Chains(PetscInt n_masses, std::vector<double> stiffnesses, double last_mass = 1.0)
      : n(n_masses), springs(std::move(stiffnesses))
  {
    const auto n_chains = static_cast<PetscInt>(springs.size());
    const PetscInt n_rows = n * n_chains;
    K = linear::testing::matrix(n_rows, 3, [&](PetscInt i) {
      const double k = springs[i % n_chains];
      linear::testing::Row row{{i, 2.0 * k}};
      if (i >= n_chains) row.emplace_back(i - n_chains, -k);
      if (i + n_chains < n_rows) row.emplace_back(i + n_chains, -k);
      return row;
    });
    M = linear::testing::matrix(n_rows, 1, [&](PetscInt i) {
      return linear::testing::Row{{i, i % n_chains == n_chains - 1 ? last_mass : 1.0}};
    });
  }
  /// k 4 sin^2(j pi / (2 (n + 1))) of all chains with mass.
  std::vector<double> exact(std::size_t n_with_mass) const
  {
    std::vector<double> lambda;
    for (std::size_t c = 0; c < n_with_mass; ++c)
      for (int j = 1; j <= n; ++j) {
        lambda.push_back(4.0 * springs[c] *
                         std::pow(std::sin(0.5 * j * std::numbers::pi / (double(n) + 1)), 2));
      }
    std::ranges::sort(lambda);
    return lambda;
  }
  PetscInt n;
  std::vector<double> springs;
  petsc::Matrix K, M;
};

linear::PartedLanczos by_parts(const linear::Factorization& K, Mat M)
{
  std::vector<linear::DecoupledPart> parts;
  for (petsc::IndexSet& rows : linear::decoupled_rows(K.matrix(), M)) {
    linear::BlockSolve solve = linear::part_solver(K.factor(), rows);
    parts.push_back({.rows = std::move(rows), .solve = std::move(solve)});
  }
  return {std::move(parts), M, {.n_pairs = 0}};
}

void expect_pairs(const linear::PartedLanczos& found, const Chains& chains,
                  const std::vector<double>& exact)
{
  for (PetscInt i = 0; i < found.n_pairs(); ++i)
    EXPECT_NEAR(found.lambda(i), exact[i], 1e-10 * exact[i]) << "pair " << i;
  const petsc::Matrix X = found.vectors(0, found.n_pairs());
  petsc::Matrix KX = linear::uninitialized_dense(chains.K, found.n_pairs()),
                MX = linear::uninitialized_dense(chains.K, found.n_pairs());
  linear::SparseProduct(chains.K).apply(X, KX);
  linear::SparseProduct(chains.M).apply(X, MX);
  const Eigen::MatrixXd K_r = linear::inner_product(X, KX), M_r = linear::inner_product(X, MX);
  for (Eigen::Index i = 0; i < K_r.rows(); ++i) {
    for (Eigen::Index j = 0; j < K_r.cols(); ++j) {
      const double size = std::sqrt(exact[i] * exact[j]);
      EXPECT_NEAR(M_r(i, j), i == j ? 1.0 : 0.0, 1e-12) << i << ", " << j;
      EXPECT_NEAR(K_r(i, j), i == j ? exact[i] : 0.0, 1e-9 * size) << i << ", " << j;
    }
  }
}

TEST(PartedLanczos, FindsTheLowestOfPartsWithFewAndWithManyInTheRange)
{
  const Chains chains(150, {1.0, 30.0, 3.0});
  const linear::Factorization K(chains.K);
  linear::PartedLanczos lanczos = by_parts(K, chains.M);
  lanczos.converge(40);
  ASSERT_EQ(lanczos.n_pairs(), 40);
  expect_pairs(lanczos, chains, chains.exact(3));
}

TEST(PartedLanczos, GoesOnWhereItStopped)
{
  const Chains chains(150, {1.0, 30.0});
  const linear::Factorization K(chains.K);
  linear::PartedLanczos lanczos = by_parts(K, chains.M);
  for (const PetscInt n : {1, 7, 30, 60}) {
    lanczos.converge(n);
    ASSERT_EQ(lanczos.n_pairs(), n);
    expect_pairs(lanczos, chains, chains.exact(2));
  }
}

TEST(PartedLanczos, FindsAllCopiesOfEigenvaluesThatSeveralPartsHave)
{
  const Chains chains(60, {2.0, 2.0, 2.0, 2.0});
  const linear::Factorization K(chains.K);
  linear::PartedLanczos lanczos = by_parts(K, chains.M);
  lanczos.converge(26);
  ASSERT_EQ(lanczos.n_pairs(), 26);
  expect_pairs(lanczos, chains, chains.exact(4));
}

TEST(PartedLanczos, EndsWhereAPartHasNoMore)
{
  const Chains chains(24, {1.0, 400.0});
  const linear::Factorization K(chains.K);
  linear::PartedLanczos lanczos = by_parts(K, chains.M);
  lanczos.converge(30);
  ASSERT_EQ(lanczos.n_pairs(), 30);
  expect_pairs(lanczos, chains, chains.exact(2));
  lanczos.converge(100);
  ASSERT_EQ(lanczos.n_pairs(), 48);  // all there are
  expect_pairs(lanczos, chains, chains.exact(2));
}

TEST(PartedLanczos, FindsNothingInAPartWithoutMass)
{
  const Chains chains(100, {1.0, 2.0}, 0.0);
  const linear::Factorization K(chains.K);
  linear::PartedLanczos lanczos = by_parts(K, chains.M);
  lanczos.converge(20);
  ASSERT_EQ(lanczos.n_pairs(), 20);
  expect_pairs(lanczos, chains, chains.exact(1));
}

TEST(PartedLanczos, TakesFewerNumbersThanTheWhole)
{
  const Chains chains(1000, {1.0, 16.0});
  const linear::Factorization K(chains.K);
  linear::PartedLanczos parts = by_parts(K, chains.M), whole(K.factor(), chains.M, {.n_pairs = 0});
  parts.converge(100);
  whole.converge(100);
  EXPECT_LT(parts.numbers_solved(), 0.7 * whole.numbers_solved());
}

TEST(ModeSearch, SolvesForPartsByThemselves)
{
  const Chains chains(150, {1.0, 30.0});
  const linear::Factorization K(chains.K);
  ModeSearch search(K, chains.M);
  search.find(20);
  EXPECT_EQ(search.n_parts(), 2);
  const std::vector<double> exact = chains.exact(2);
  ASSERT_GE(search.omega().size(), 20u);
  for (std::size_t i = 0; i < search.omega().size(); ++i)
    EXPECT_NEAR(search.omega()[i], std::sqrt(exact[i]), 1e-10 * std::sqrt(exact[i]));
}

}  // namespace
}  // namespace chladni::reduce
