#include "reduce/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "common/petsc.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

using linear::testing::free_chain;
using linear::testing::master_set;

TEST(Partition, DividesAllDofsIntoMastersAndSlaves)
{
  const linear::testing::Chain chain = free_chain(12);
  const DofPartition dofs = partition(chain.K, master_set(chain.K, {11, 0, 5}));
  PetscInt n_m = 0, n_s = 0;
  petsc::check(ISGetSize(dofs.masters, &n_m));
  petsc::check(ISGetSize(dofs.slaves, &n_s));
  EXPECT_EQ(n_m, 3);
  EXPECT_EQ(n_s, 9);
}

TEST(Partition, RefusesNoMastersAndNoSlavesOnAllRanks)
{
  const linear::testing::Chain chain = free_chain(6);
  EXPECT_THROW(partition(chain.K, master_set(chain.K, {})), Error);
  EXPECT_NO_THROW(partition(chain.K, master_set(chain.K, {}), 0));
  EXPECT_THROW(partition(chain.K, master_set(chain.K, {0, 1, 2, 3, 4, 5})), Error);
}

TEST(Partition, RefusesADoubleMaster)
{
  const linear::testing::Chain chain = free_chain(6);
  EXPECT_THROW(partition(chain.K, master_set(chain.K, {2, 2})), Error);
}

/// A chain of which every other node moves in another direction that nothing couples with.
TEST(OrderSlaves, PutsThoseThatNothingCouplesOneAfterTheOther)
{
  constexpr PetscInt n = 200;
  const auto chains = [](double own, double next) {
    return linear::testing::matrix(n, 3, [=](PetscInt i) {
      linear::testing::Row row{{i, own}};
      if (i > 1) row.emplace_back(i - 2, next);
      if (i + 2 < n) row.emplace_back(i + 2, next);
      return row;
    });
  };
  const petsc::Matrix K = chains(2.0, -1.0), M = chains(1.0, 0.0);
  DofPartition dofs = partition(K, master_set(K, {0, 1, n - 1}));
  const std::vector<PetscInt> before = petsc::own_indices(dofs.slaves);
  const std::vector<int> places = order_slaves(dofs, K, M);
  std::vector<PetscInt> now = petsc::own_indices(dofs.slaves);
  const auto parity = [](PetscInt i) { return i % 2; };
  EXPECT_TRUE(std::ranges::is_partitioned(now, [&](PetscInt i) { return parity(i) == 0; }) ||
              std::ranges::is_partitioned(now, [&](PetscInt i) { return parity(i) == 1; }));
  std::ranges::sort(now);
  EXPECT_EQ(now, before);
  if (petsc::rank(PETSC_COMM_WORLD) != 0) {
    EXPECT_TRUE(places.empty());
    return;
  }
  std::vector<int> sorted = places, all(n - 3);
  std::ranges::sort(sorted);
  std::iota(all.begin(), all.end(), 1);
  EXPECT_EQ(sorted, all);
}

/// The order in which rows come must not matter to anything.
TEST(OrderSlaves, TellsWhichDofARowIs)
{
  constexpr PetscInt n = 90;
  const linear::testing::Chain chain = free_chain(n);
  DofPartition dofs = partition(chain.K, master_set(chain.K, {4, n - 1}));
  order_slaves(dofs, chain.K, chain.M);
  const std::vector<PetscInt> all = all_slaves(dofs);
  ASSERT_EQ(all.size(), std::size_t(n) - 2);
  EXPECT_FALSE(std::ranges::is_sorted(all));
  for (PetscInt row = 0; row < n - 2; ++row)
    EXPECT_EQ(dof_of_slave(dofs, row), all[std::size_t(row)]);
}

TEST(Split, HasTheTransposeOfSmInMs)
{
  const linear::testing::Chain chain = free_chain(12);
  const DofPartition dofs = partition(chain.K, master_set(chain.K, {3, 8}));
  const Blocks K = split(chain.K, dofs);
  petsc::Matrix transposed;
  petsc::check(MatTranspose(K.sm, MAT_INITIAL_MATRIX, transposed.put()));
  PetscBool equal = PETSC_FALSE;
  petsc::check(MatEqual(transposed, K.ms, &equal));
  EXPECT_TRUE(equal);
}

}  // namespace
}  // namespace chladni::reduce
