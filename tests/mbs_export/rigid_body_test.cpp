#include "mbs_export/free_modes.hpp"

#include <gtest/gtest.h>

#include "bending_beam.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using test::rim_node_inertia, test::rim_node_mass, test::wheel_height, test::wheel_radius,
    test::hub_inertia, test::hub_mass, test::wheel_rim_nodes;

TEST(RigidBodyVectors, CostNoEnergyInAFreeWheel)
{
  const ReducedSystem wheel = test::wheel();
  const auto R = rigid_body_vectors(wheel, {0.3, -0.2, 0.5});
  // Round-off of K R: eps times the largest entry of K (1e8 N/m).
  EXPECT_LT((wheel.K * R).cwiseAbs().maxCoeff(), 1e-15 * 1e3 * wheel.K.cwiseAbs().maxCoeff());
}

TEST(RigidInertia, OfAWheelIsThatOfItsPointMasses)
{
  const RigidInertia rigid = rigid_inertia(test::wheel());
  const double m_rim = wheel_rim_nodes * rim_node_mass, mass = m_rim + hub_mass;
  const double z = m_rim * wheel_height / mass;
  const double own = wheel_rim_nodes * rim_node_inertia + hub_inertia;
  const double J_z = own + m_rim * wheel_radius * wheel_radius;
  const double J_x =
      own + m_rim * (0.5 * wheel_radius * wheel_radius + (wheel_height - z) * (wheel_height - z)) +
      hub_mass * z * z;
  EXPECT_NEAR(rigid.mass, mass, 1e-14);
  EXPECT_LT((rigid.centre_of_mass - Eigen::Vector3d(0, 0, z)).norm(), 1e-15);
  const Eigen::Matrix3d J = Eigen::Vector3d(J_x, J_x, J_z).asDiagonal();
  EXPECT_LT((rigid.inertia - J).norm(), 1e-15);
}

TEST(RigidInertia, OfAReducedBeamIsExactInTheComponentsThatItHas)
{
  // L = rho A = 1: mass 1, centre 1/2, J_y = 1/12; consistent mass integrates rigid motion exactly.
  // Round-off of M_r through K_ss^-1 (condition 4.5e9) leaves 1e-10 or better.
  const RigidInertia rigid = rigid_inertia(test::regression_beam());
  EXPECT_NEAR(rigid.mass, 1.0, 1e-9);
  EXPECT_NEAR(rigid.centre_of_mass.x(), 0.5, 1e-9);
  EXPECT_NEAR(rigid.inertia(1, 1), 1.0 / 12.0, 1e-9);
  EXPECT_EQ(rigid.inertia(2, 2), 0.0);
}

}  // namespace
}  // namespace chladni::mbs_export
