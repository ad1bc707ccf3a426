#include "linear/kernels/small_matrices.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(SymmetricEigen, HasNoRoundOffBetweenRowsThatAreNotCoupled)
{
  // Two matrices that lie into each other, with a common eigenvalue and others that are close.
  constexpr PetscInt n = 20;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (PetscInt i = 0; i < n; ++i) {
    A(i, i) = i % 2 == 0 ? 2.0 : 2.0 + 1e-9 * double(i);
    if (i > 1) A(i, i - 2) = A(i - 2, i) = -1.0;
  }
  const SymmetricEigen eigen = symmetric_eigen(A);
  EXPECT_TRUE(std::ranges::is_sorted(eigen.values));
  EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - Eigen::MatrixXd::Identity(n, n)).norm(),
            1e-13);
  for (PetscInt k = 0; k < n; ++k) {
    const Eigen::VectorXd v = eigen.vectors.col(k);
    EXPECT_LT((A * v - eigen.values[std::size_t(k)] * v).norm(), 1e-13);
    const bool is_even = v(Eigen::seq(1, n - 1, 2)).isZero(0.0),
               is_odd = v(Eigen::seq(0, n - 2, 2)).isZero(0.0);
    EXPECT_NE(is_even, is_odd) << k;
  }
}

TEST(SymmetricEigen, OfAnEmptyMatrixIsEmpty)
{
  EXPECT_TRUE(symmetric_eigen({}, PETSC_COMM_WORLD).values.empty());
}

}  // namespace
}  // namespace chladni::linear
