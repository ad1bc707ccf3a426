#include "linear/dense/rank_update.hpp"

#include <gtest/gtest.h>

namespace chladni::linear {
namespace {

using Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

TEST(SubtractFromSymmetric, IsTheProductForAnyNumberOfColumns)
{
  std::srand(3);
  for (const int n : {1, 2, 9, 31}) {
    for (const int k : {0, 1, 2, 3, 7}) {
      const MatrixXcd U = MatrixXcd::Random(n, k), some = MatrixXcd::Random(k, k),
                      all = MatrixXcd::Random(n, n);
      const MatrixXcd S = (some + some.transpose()) * U.transpose(), before = all + all.transpose();
      const MatrixXcd expected = before - U * S;
      MatrixXcd A = before;
      A.triangularView<Eigen::StrictlyUpper>().setConstant(1e3);  // not used
      const VectorXd without = norms_without(U, S, A), norms = subtract_from_symmetric(U, S, A);
      EXPECT_EQ(without, norms);
      const MatrixXcd difference = A - expected;
      EXPECT_LT(difference.triangularView<Eigen::Lower>().toDenseMatrix().cwiseAbs().maxCoeff(),
                1e-13)
          << n << ", " << k;
      EXPECT_LT((norms - expected.colwise().norm().transpose()).cwiseAbs().maxCoeff(), 1e-12)
          << n << ", " << k;
      const MatrixXd B = MatrixXd::Random(n, 3);
      EXPECT_LT((symmetric_product(A, B) - expected * B).cwiseAbs().maxCoeff(), 1e-12)
          << n << ", " << k;
    }
  }
}

}  // namespace
}  // namespace chladni::linear
