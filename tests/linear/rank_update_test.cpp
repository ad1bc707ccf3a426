#include "linear/dense/rank_update.hpp"

#include <gtest/gtest.h>

namespace chladni::linear {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

TEST(SubtractOfLowRank, IsTheProductForAnyNumberOfColumns)
{
  std::srand(3);
  for (const int k : {0, 1, 2, 3, 4, 7}) {
    const MatrixXd U = MatrixXd::Random(121, k), S = MatrixXd::Random(k, 9);
    MatrixXd A = MatrixXd::Random(121, 9);
    const MatrixXd expected = A - U * S;
    const VectorXd squares = subtract_of_low_rank(U, S, A.data());
    EXPECT_LT((A - expected).cwiseAbs().maxCoeff(), 1e-14) << k;
    EXPECT_LT((squares - expected.colwise().squaredNorm().transpose()).cwiseAbs().maxCoeff(), 1e-12)
        << k;
  }
}

}  // namespace
}  // namespace chladni::linear
