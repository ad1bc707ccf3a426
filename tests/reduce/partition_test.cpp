#include "reduce/partition.hpp"

#include <gtest/gtest.h>

#include "tests/linear/chain.hpp"

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
