#include "reduce/rigid_constraint_modes.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "linear/kernels/dense_matrices.hpp"
#include "reduce/basis_rows.hpp"
#include "reduce/craig_bampton.hpp"
#include "tests/linear/chain.hpp"
#include "tests/linear/matrices.hpp"

namespace chladni::reduce {
namespace {

constexpr PetscInt n = 40, half = n / 2;

/// Two free chains that nothing joins, each with its first mass as master, and constraint modes
/// that a solver has left off by a millionth.
struct TwoChains {
  petsc::Matrix K = linear::testing::matrix(n, 3, [](PetscInt i) {
    const bool is_end = i % half == 0 || i % half == half - 1;
    linear::testing::Row row{{i, is_end ? 1.0 : 2.0}};
    if (i % half != 0) row.emplace_back(i - 1, -1.0);
    if (i % half != half - 1) row.emplace_back(i + 1, -1.0);
    return row;
  });
  DofPartition dofs = partition(K, linear::testing::master_set(K, {0, half}));
  Blocks blocks = split(K, dofs);
  linear::Factorization K_ss = linear::factorize(blocks.ss);

  /// The basis with the motions that are known, [n x k].
  Eigen::MatrixXd basis_with(const Eigen::MatrixXd& motions) const
  {
    petsc::Matrix R = linear::uninitialized_dense(K, motions.cols());
    PetscInt first = 0, last = 0;
    petsc::check(MatGetOwnershipRange(K, &first, &last));
    for (PetscInt i = first; i < last; ++i)
      for (PetscInt j = 0; j < motions.cols(); ++j)
        petsc::check(MatSetValue(R, i, j, motions(i, j), INSERT_VALUES));
    linear::testing::finish(R);
    petsc::Matrix Psi = constraint_modes(K_ss, blocks);
    petsc::check(MatScale(Psi, 1.0 + 1e-6));
    Psi = with_rigid_motions(std::move(Psi), {.R = R, .dofs = dofs, .K = blocks});
    std::vector<PetscInt> all(n);
    std::iota(all.begin(), all.end(), 0);
    return basis_rows({.Psi = std::move(Psi), .modes = {}}, dofs, all);
  }
};

TEST(RigidConstraintModes, LeaveAtRestWhatNothingJoins)
{
  Eigen::MatrixXd each = Eigen::MatrixXd::Zero(n, 2);
  each.topLeftCorner(half, 1).setOnes();
  each.bottomRightCorner(half, 1).setOnes();
  const Eigen::MatrixXd Q = TwoChains().basis_with(each);
  for (PetscInt i = 0; i < n; ++i) {
    EXPECT_NEAR(Q(i, i / half), 1.0, 1e-14) << i;
    EXPECT_EQ(Q(i, 1 - i / half), 0.0) << i;
  }
}

TEST(RigidConstraintModes, CarryAMotionThatPartsShareWithoutAMaster)
{
  const Eigen::MatrixXd Q = TwoChains().basis_with(Eigen::MatrixXd::Ones(n, 1));
  for (PetscInt i = 0; i < n; ++i) EXPECT_NEAR(Q.row(i).sum(), 1.0, 1e-14) << i;
}

}  // namespace
}  // namespace chladni::reduce
