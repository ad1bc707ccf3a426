#include "mbs_export/free_modes.hpp"

#include <gtest/gtest.h>

#include "bending_beam.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::MatrixXd;

TEST(Orthogonalize, FindsTheRigidMotionsOfAStiffModelWithFewModes)
{
  // K_r of 300 elements resists rigid motion by 8e-6, round-off of an FE model whose largest
  // stiffness-to-mass ratio three modes no longer show.
  ReducedSystem beam = test::regression_beam();
  beam.K = beam.K.topLeftCorner(9, 9).eval();
  beam.M = beam.M.topLeftCorner(9, 9).eval();
  beam.fixed_interface_frequencies = beam.fixed_interface_frequencies.head(3).eval();
  const FreeModes modes = orthogonalize(beam);
  EXPECT_EQ(modes.n_rigid, 2);
  EXPECT_NEAR(modes.omega[2], 22.3733, 0.01);  // three modes are that good
}

TEST(Orthogonalize, FindsTheTwoRigidMotionsOfABendingBeam)
{
  const ReducedSystem& beam = test::regression_beam();
  const FreeModes modes = orthogonalize(beam);
  EXPECT_EQ(modes.n_rigid, 2);
  EXPECT_EQ(modes.omega.size(), 106);
  EXPECT_EQ(modes.omega[1], 0.0);
  EXPECT_LT(modes.rigid_residual, 1e-7);  // round-off of K_r: 1e-6 against omega^2 = 500
  // Free-free beam: 60-digit arithmetic on the same 300 elements gives 22.37328545287856 and
  // 61.67282298642806; the reduction adds less than 1e-10, round-off of K_r about 1e-8.
  EXPECT_NEAR(modes.omega[2] / 22.37328545287856, 1.0, 3e-8);
  EXPECT_NEAR(modes.omega[3] / 61.67282298642806, 1.0, 3e-8);
}

TEST(Orthogonalize, MakesMassIdentityAndStiffnessDiagonal)
{
  const ReducedSystem& beam = test::regression_beam();
  const FreeModes modes = orthogonalize(beam);
  const MatrixXd M_e = modes.Q_e.transpose() * beam.M * modes.Q_e;
  // eps cond(M_r) = 2e-16 * 4e8, twice for two-sided products
  EXPECT_LT((M_e - MatrixXd::Identity(106, 106)).cwiseAbs().maxCoeff(), 1e-8);
  MatrixXd K_e = modes.Q_e.transpose() * beam.K * modes.Q_e;
  K_e.diagonal() -= modes.omega.cwiseAbs2();
  EXPECT_LT(K_e.cwiseAbs().maxCoeff(), 1e-8 * modes.omega.cwiseAbs2().maxCoeff());
}

TEST(Orthogonalize, FindsSixRigidMotionsWhereverTheOriginIs)
{
  ReducedSystem wheel = test::wheel();
  for (AttachmentNode& node : wheel.attachment_nodes) node.position += Eigen::Vector3d(50, -20, 7);
  const FreeModes modes = orthogonalize(wheel);
  EXPECT_EQ(modes.n_rigid, 6);
  EXPECT_GT(modes.omega[6], 100.0);
  EXPECT_LT(modes.rigid_residual, 1e-9);
}

TEST(Orthogonalize, CountsOnlyMotionsThatNothingResists)
{
  ReducedSystem wheel = test::wheel();
  const int hub = 6 * test::wheel_rim_nodes;
  wheel.K(hub + 2, hub + 2) += 1e3;  // a soft support: 4 Hz beside elastic modes of kHz
  const FreeModes supported = orthogonalize(wheel);
  EXPECT_EQ(supported.n_rigid, 5);
  // One mass on one spring, as long as the elastic modes are far above: 1e-4 = (4 Hz / 400 Hz)^2
  const double mass = test::wheel_rim_nodes * test::rim_node_mass + test::hub_mass;
  EXPECT_NEAR(supported.omega[5] / std::sqrt(1e3 / mass), 1.0, 1e-3);
  wheel.K.diagonal().tail(6).array() += 1e5;
  EXPECT_EQ(orthogonalize(wheel).n_rigid, 0);
}

TEST(Orthogonalize, RefusesAStructureInTwoParts)
{
  ReducedSystem wheel = test::wheel();
  const int hub = 6 * test::wheel_rim_nodes;
  wheel.K.middleRows(hub, 6).setZero();
  wheel.K.middleCols(hub, 6).setZero();
  EXPECT_NE(files::test::error_of([&] { orthogonalize(wheel); }), "");
}

TEST(Orthogonalize, RefusesABodyWithoutMass)
{
  ReducedSystem wheel = test::wheel();
  wheel.M.setZero();
  EXPECT_NE(files::test::error_of([&] { orthogonalize(wheel); }).find("no mass"),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
