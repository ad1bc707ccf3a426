#include "linear/dense/dense_solvers.hpp"
#include "reduce/cyclic/harmonic_model.hpp"

#include <gtest/gtest.h>

namespace chladni::cyclic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// diag of [0 -1; 1 0]: J of modes in pairs.
MatrixXd quarter_turns(Index n)
{
  MatrixXd J = MatrixXd::Zero(n, n);
  for (Index k = 0; k + 1 < n; k += 2) {
    J(k, k + 1) = -1.0;
    J(k + 1, k) = 1.0;
  }
  return J;
}

/// Any mixture of these modes.
MatrixXd mixture(Index n, unsigned seed)
{
  std::srand(seed);
  return linear::columns_of_Q(Eigen::HouseholderQR<MatrixXd>(MatrixXd::Random(n, n)), n);
}

TEST(ExactPairs, AreFoundInAnyMixtureOfAClusterOfFour)
{
  const MatrixXd Q = mixture(4, 7);
  const MatrixXd S = Q.transpose() * quarter_turns(4) * Q;
  const ExactPairs pairs = exact_pairs(VectorXd::Constant(4, 3.0), S);
  ASSERT_EQ(pairs.W.cols(), 4);
  EXPECT_LT((pairs.W.transpose() * pairs.W - MatrixXd::Identity(4, 4)).norm(), 1e-14);
  EXPECT_LT((pairs.W.transpose() * S * pairs.W - quarter_turns(4)).norm(), 1e-14);
}

TEST(ExactPairs, KeepPairsOfDifferentFrequencyApart)
{
  MatrixXd Q = MatrixXd::Zero(4, 4);
  Q.topLeftCorner<2, 2>() = mixture(2, 1);
  Q.bottomRightCorner<2, 2>() = mixture(2, 2);
  const VectorXd omega = (VectorXd(4) << 2.0, 2.0 + 1e-12, 5.0, 5.0 + 1e-12).finished();
  const ExactPairs pairs = exact_pairs(omega, Q.transpose() * quarter_turns(4) * Q);
  ASSERT_EQ(pairs.omega.size(), 4);
  EXPECT_EQ(pairs.omega[0], pairs.omega[1]);
  EXPECT_EQ(pairs.omega[2], pairs.omega[3]);
  EXPECT_NEAR(pairs.omega[0], 2.0, 1e-11);
  EXPECT_NEAR(pairs.omega[2], 5.0, 1e-11);
  EXPECT_LT(pairs.W.topRightCorner(2, 2).norm() + pairs.W.bottomLeftCorner(2, 2).norm(), 1e-15);
}

TEST(ExactPairs, LeaveOutAModeWithoutItsPartner)
{
  MatrixXd S = quarter_turns(4).topLeftCorner(3, 3);  // the partner of the third is not there
  const ExactPairs pairs = exact_pairs((VectorXd(3) << 2.0, 2.0, 5.0).finished(), S);
  EXPECT_EQ(pairs.omega.size(), 2);
}

}  // namespace
}  // namespace chladni::cyclic
