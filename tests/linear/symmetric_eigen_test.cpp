#include "linear/kernels/symmetric_eigen.hpp"

#include <gtest/gtest.h>

namespace chladni::linear {
namespace {

/// A chain with a spring that is the softer the higher the rank: as if round-off were large.
Eigen::MatrixXd chain_of_rank(int rank)
{
  constexpr PetscInt n = 5;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (PetscInt i = 0; i < n; ++i) {
    A(i, i) = 2.0 - 0.1 * rank;
    if (i > 0) A(i, i - 1) = A(i - 1, i) = -1.0;
  }
  return A;
}

TEST(SymmetricEigen, IsOnAllRanksThatOfTheFirst)
{
  const SymmetricEigen own = symmetric_eigen(chain_of_rank(0));
  const SymmetricEigen told =
      symmetric_eigen(chain_of_rank(petsc::rank(PETSC_COMM_WORLD)), PETSC_COMM_WORLD);
  EXPECT_EQ(told.values, own.values);
  EXPECT_EQ(told.vectors, own.vectors);
}

TEST(SymmetricEigen, OfAnEmptyMatrixIsEmpty)
{
  EXPECT_TRUE(symmetric_eigen({}, PETSC_COMM_WORLD).values.empty());
}

}  // namespace
}  // namespace chladni::linear
