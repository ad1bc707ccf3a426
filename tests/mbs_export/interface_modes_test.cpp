#include "mbs_export/response_error.hpp"

#include <gtest/gtest.h>

#include "tests/common/files/scratch_folder.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

TEST(ResponseModes, SolveTheForcedVibrationOfTheNeglectedModes)
{
  const VectorXd omega{{2.0, 5.0, 9.0}};
  const MatrixXd g{{1.0, 0.5}, {-2.0, 0.0}, {3.0, 1.0}};
  const double Omega_0 = 3.0;
  const MatrixXd phi = response_modes(omega, g, Omega_0);
  const MatrixXd dynamic = VectorXd(omega.array().square() - Omega_0 * Omega_0).asDiagonal();
  EXPECT_LT((dynamic * phi - g).norm(), 1e-15);
}

TEST(ResponseModes, ProposeAnotherFrequencyBesideANeglectedOne)
{
  const VectorXd omega{{2.0, 5.0, 5.0, 9.0}};
  const MatrixXd g = MatrixXd::Ones(4, 1);
  const std::string error =
      files::test::error_of([&] { response_modes(omega, g, 5.0 * (1.0 + 1e-12)); });
  EXPECT_NE(error.find("take omega0 = 3.5"), std::string::npos) << error;
  // A free body whose rigid modes are neglected has no static response.
  const VectorXd free{{0.0, 4.0}};
  const std::string rigid =
      files::test::error_of([&] { response_modes(free, MatrixXd::Ones(2, 1), 0.0); });
  EXPECT_NE(rigid.find("take omega0 = 2"), std::string::npos) << rigid;
}

TEST(InterfaceBasis, IsOrthonormalAndDropsWhatDependsOnOthers)
{
  const VectorXd omega{{2.0, 5.0, 9.0, 12.0}};
  MatrixXd P(4, 3);
  P.col(0) << 1, 2, 3, 4;
  P.col(1) << 1e-6, 0, 0, 1e-6;  // size alone is no reason to drop
  P.col(2) = 2.0 * P.col(0) + 3e5 * P.col(1) + VectorXd::Constant(4, 1e-10);
  const InterfaceBasis basis = interface_basis(omega, P);
  EXPECT_EQ(basis.n_dropped, 1);
  ASSERT_EQ(basis.V.cols(), 2);
  EXPECT_LT((basis.V.transpose() * basis.V - MatrixXd::Identity(2, 2)).norm(), 1e-14);
  const MatrixXd K = basis.V.transpose() * omega.cwiseAbs2().asDiagonal() * basis.V;
  EXPECT_LT((K - MatrixXd(basis.omega.cwiseAbs2().asDiagonal())).norm(), 1e-12);
  EXPECT_LT((P.col(0) - basis.V * (basis.V.transpose() * P.col(0))).norm(), 1e-8);
}

}  // namespace
}  // namespace chladni::mbs_export
