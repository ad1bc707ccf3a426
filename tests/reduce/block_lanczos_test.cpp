#include "linear/lanczos/block_lanczos.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "linear/cholesky/factorization.hpp"
#include "linear/lanczos/block_basis.hpp"
#include "pencils.hpp"
#include "reduce/partition.hpp"
#include "tests/linear/chain.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::free_chain;
using linear::testing::master_set;

/// A chain of n masses between fixed ends: lambda_k = 4 sin^2(k pi / (2 (n + 1))).
struct FixedChain {
  explicit FixedChain(PetscInt n) : chain(free_chain(n + 2))
  {
    const DofPartition dofs = partition(chain.K, master_set(chain.K, {0, n + 1}));
    K = split(chain.K, dofs);
    M = split(chain.M, dofs);
  }
  linear::testing::Chain chain;
  Blocks K, M;
};

double exact_of_chain(int k, int n)
{
  return 4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / (n + 1)), 2);
}

void expect_exact(const linear::EigenPairs& pairs, int n)
{
  for (std::size_t i = 0; i < pairs.lambda.size(); ++i) {
    const double lambda = exact_of_chain(static_cast<int>(i) + 1, n);
    // The error of lambda is the square of the residual; what remains is cond(K) = 4 n^2 / pi^2
    // times round-off.
    EXPECT_NEAR(pairs.lambda[i], lambda, 1e-11 * lambda) << "pair " << i + 1;
  }
}

TEST(BlockLanczos, FindsTheLowestPairsOfAChain)
{
  const FixedChain c(200);
  const linear::Factorization factor(c.K.ss);
  const linear::EigenPairs pairs = linear::block_lanczos(factor.factor(), c.M.ss, {.n_pairs = 12});
  ASSERT_EQ(pairs.lambda.size(), 12u);
  expect_exact(pairs, 200);
}

TEST(BlockLanczos, GivesTheSameWhenItMustRestart)
{
  const FixedChain c(400);
  const linear::Factorization factor(c.K.ss);
  const linear::BlockLanczosOptions options{.n_pairs = 40, .block_size = 4, .max_subspace = 60};
  const linear::EigenPairs pairs = linear::block_lanczos(factor.factor(), c.M.ss, options);
  EXPECT_GT(pairs.n_solves, 64);  // it did restart
  expect_exact(pairs, 400);
}

TEST(BlockLanczos, GoesOnWhereItStoppedWhenMoreAreAsked)
{
  const FixedChain c(200);
  const linear::Factorization factor(c.K.ss);
  for (const PetscInt subspace : {0, 40}) {  // the latter restarts in between
    const linear::BlockLanczosOptions options{
        .n_pairs = 20, .block_size = 4, .max_subspace = subspace};
    linear::BlockLanczos lanczos(factor.factor(), c.M.ss, options);
    lanczos.converge(6);
    const PetscInt n_first = lanczos.n_solves();
    lanczos.converge(20);
    // A restart forgets the directions that it drops; nothing else is done twice.
    const PetscInt n_alone = linear::block_lanczos(factor.factor(), c.M.ss, options).n_solves;
    EXPECT_LE(lanczos.n_solves(), n_alone + (subspace > 0 ? n_first : options.block_size));
    ASSERT_EQ(lanczos.n_pairs(), 20);
    for (int i = 0; i < 20; ++i)
      EXPECT_NEAR(lanczos.lambda(i) / exact_of_chain(i + 1, 200), 1.0, 1e-11);
    const petsc::Matrix X = lanczos.vectors(3, 15);
    const Eigen::MatrixXd I = linear::inner_product(X, X);  // M = I
    for (PetscInt i = 0; i < 12; ++i)
      for (PetscInt j = 0; j < 12; ++j) EXPECT_NEAR(I(i, j), i == j ? 1.0 : 0.0, 1e-12);
  }
}

TEST(BlockLanczos, HasOrthonormalVectors)
{
  const FixedChain c(200);
  const linear::Factorization factor(c.K.ss);
  const linear::EigenPairs pairs = linear::block_lanczos(factor.factor(), c.M.ss, {.n_pairs = 20});
  const Eigen::MatrixXd I = linear::inner_product(pairs.X, pairs.X);  // M = I
  for (PetscInt i = 0; i < I.rows(); ++i)
    for (PetscInt j = 0; j < I.cols(); ++j) EXPECT_NEAR(I(i, j), i == j ? 1.0 : 0.0, 1e-12);
}

TEST(BlockLanczos, ExhaustsASmallProblem)
{
  const FixedChain c(9);
  const linear::Factorization factor(c.K.ss);
  const linear::EigenPairs pairs = linear::block_lanczos(factor.factor(), c.M.ss, {.n_pairs = 9});
  ASSERT_EQ(pairs.lambda.size(), 9u);
  expect_exact(pairs, 9);
}

TEST(BlockLanczos, SaysWhenItDoesNotConverge)
{
  const FixedChain c(200);
  const linear::Factorization factor(c.K.ss);
  const std::vector<std::string> numbers = testing::refused_numbers(
      [&] { linear::block_lanczos(factor.factor(), c.M.ss, {.n_pairs = 20, .max_steps = 4}); });
  ASSERT_EQ(numbers.size(), 2u);  // what was asked, and what was reached
  EXPECT_GT(std::stod(numbers[1]), std::stod(numbers[0]));
  EXPECT_LT(std::stod(numbers[1]), 1.0);
}

TEST(BlockBasis, LeavesOutADependentDirection)
{
  const FixedChain c(30);
  linear::BlockBasis basis(c.M.ss, 10);
  petsc::Matrix block = basis.new_block(3);
  PetscInt first = 0, last = 0;
  petsc::check(MatGetOwnershipRange(block, &first, &last));
  for (PetscInt i = first; i < last; ++i) {
    petsc::check(MatSetValue(block, i, 0, 1.0, INSERT_VALUES));
    petsc::check(MatSetValue(block, i, 1, double(i), INSERT_VALUES));
    petsc::check(MatSetValue(block, i, 2, 2.0 * i - 3.0, INSERT_VALUES));  // of the first two
  }
  linear::testing::finish(block);
  EXPECT_EQ(basis.append(block).R.rows(), 2);
  EXPECT_EQ(basis.n_columns(), 2);
}

}  // namespace
}  // namespace chladni::reduce
