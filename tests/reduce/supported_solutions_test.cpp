#include "reduce/supported_solutions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "linear/kernels/dense_matrices.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::free_chain;

/// 1 at one DOF.
petsc::Vector unit(Mat K, PetscInt i)
{
  petsc::Vector f;
  petsc::check(MatCreateVecs(K, nullptr, f.put()));
  petsc::check(VecSetValue(f, i, 1.0, ADD_VALUES));
  petsc::check(VecAssemblyBegin(f));
  petsc::check(VecAssemblyEnd(f));
  const double n_ranks = petsc::size(PETSC_COMM_WORLD);
  petsc::check(VecScale(f, 1.0 / n_ranks));  // every rank has added its own
  return f;
}

double entry(Vec x, PetscInt i)
{
  PetscInt first = 0, last = 0;
  petsc::check(VecGetOwnershipRange(x, &first, &last));
  double value = 0.0;
  if (i >= first && i < last) petsc::check(VecGetValues(x, 1, &i, &value));
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return value;
}

TEST(StaticSolution, StretchesAHeldChainEvenly)
{
  const linear::testing::Chain chain = free_chain(21);
  const StaticSolution solution =
      static_solution(chain.K, unit(chain.K, 20), free_dofs(chain.K, {0}));
  for (const PetscInt i : {0, 7, 20}) EXPECT_NEAR(entry(solution.u, i), i, 1e-12);  // cond ~ 1e2
  EXPECT_NEAR(entry(solution.reaction, 0), -1.0, 1e-12);
  EXPECT_NEAR(entry(solution.reaction, 7), 0.0, 1e-12);
}

TEST(StaticSolution, RefusesAnIndefiniteMatrix)
{
  const linear::testing::Chain chain = free_chain(21);
  petsc::check(MatScale(chain.K, -1.0));
  EXPECT_THROW(static_solution(chain.K, unit(chain.K, 20), free_dofs(chain.K, {0})), Error);
}

/// Chain of n unit masses with free ends: 4 sin^2(k pi / (2 n)).
double eigenvalue_of_free_chain(int k, int n)
{
  return 4.0 * std::pow(std::sin(0.5 * k * std::numbers::pi / n), 2);
}

TEST(NaturalModes, OfAFreeChainBeginWithTheRigidOne)
{
  const linear::testing::Chain chain = free_chain(200);
  const NaturalModes modes =
      natural_modes(chain.K, chain.M, free_dofs(chain.K, {}), {.n_modes = 8, .n_rigid = 1});
  ASSERT_EQ(modes.lambda.size(), 8u);
  EXPECT_NEAR(modes.lambda[0], 0.0, 1e-9 * modes.lambda[1]);
  for (int k = 1; k < 8; ++k) {
    // The factor of K + mu M with mu near the first eigenvalue: cond 1e4 times round-off.
    EXPECT_NEAR(modes.lambda[k] / eigenvalue_of_free_chain(k, 200), 1.0, 1e-10);
  }
}

TEST(NaturalModes, OfAHeldChainAreZeroAtTheSupportAndNormal)
{
  const int n = 50;
  const linear::testing::Chain chain = free_chain(n + 1);
  const NaturalModes modes =
      natural_modes(chain.K, chain.M, free_dofs(chain.K, {0}), {.n_modes = 5});
  const Eigen::MatrixXd gram = linear::inner_product(modes.X, modes.X);  // M = I
  for (PetscInt i = 0; i < 5; ++i) {
    for (PetscInt j = 0; j < 5; ++j) EXPECT_NEAR(gram(i, j), i == j ? 1.0 : 0.0, 1e-9);
    const double exact =
        4.0 * std::pow(std::sin((2 * i + 1) * std::numbers::pi / (2.0 * (2 * n + 1))), 2);
    EXPECT_NEAR(modes.lambda[i] / exact, 1.0, 1e-10);
  }
  PetscInt first = 0;
  petsc::check(MatGetOwnershipRange(modes.X, &first, nullptr));
  const linear::LocalRows rows(modes.X);
  if (first == 0) {
    EXPECT_EQ(rows(0, 0), 0.0);
  }
}

TEST(NaturalModes, AreAsManyAsAreAskedForWhereTheLastOneHasAPartner)
{
  // Two equal chains, each held at its first mass.
  const PetscInt n = 60;
  const petsc::Matrix K = linear::testing::matrix(2 * n, 3, [&](PetscInt i) {
    linear::testing::Row row{{i, double(i >= 2) + double(i + 2 < 2 * n)}};
    if (i >= 2) row.emplace_back(i - 2, -1.0);
    if (i + 2 < 2 * n) row.emplace_back(i + 2, -1.0);
    return row;
  });
  const petsc::Matrix M = linear::testing::diagonal(2 * n, [](PetscInt) { return 1.0; });
  const NaturalModes modes = natural_modes(K, M, free_dofs(K, {0, 1}), {.n_modes = 3});
  ASSERT_EQ(modes.lambda.size(), 3u);
  EXPECT_EQ(linear::LocalRows(modes.X).n_cols(), 3);
  for (int k = 0; k < 3; ++k) {
    const double exact =
        4.0 * std::pow(std::sin((2 * (k / 2) + 1) * std::numbers::pi / (2.0 * (2 * n - 1))), 2);
    EXPECT_NEAR(modes.lambda[std::size_t(k)] / exact, 1.0, 1e-10) << k;
  }
}

TEST(NaturalModes, RefuseMoreThanThereAre)
{
  const linear::testing::Chain chain = free_chain(10);
  const FreeDofs free = free_dofs(chain.K, {0});
  EXPECT_THROW(natural_modes(chain.K, chain.M, free, {.n_modes = 10}), Error);
  EXPECT_THROW(free_dofs(chain.K, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), Error);
}

}  // namespace
}  // namespace chladni::reduce
