#include "mbs_export/formats/floating_body.hpp"

#include <gtest/gtest.h>

#include "../bending_beam.hpp"
#include "../wheel.hpp"
#include "mbs_export/formats/export_error.hpp"

namespace chladni::mbs_export::formats {
namespace {

using Eigen::MatrixXd;

/// The key of the scene that the refusal names; nothing where there is none.
std::string refused_key(const ReducedSystem& reduced, const BodyOptions& options)
{
  try {
    floating_body(reduced, options);
  } catch (const ExportError& error) {
    EXPECT_STREQ(error.what(), error.why().c_str());
    return error.key();
  }
  return "";
}

BodyOptions with_dampers(const std::vector<std::string>& fixed = {})
{
  BodyOptions options;
  options.fixed = fixed;
  options.damping.type = Damping::Type::matrix;
  return options;
}

/// A wheel whose material damps: C R = 0, N s/m of the size of 100.
ReducedSystem damped_wheel()
{
  ReducedSystem wheel = test::wheel();
  wheel.C = 1e-5 * wheel.K;
  return wheel;
}

TEST(FloatingBody, TakesDampersThatNoRigidMotionFeels)
{
  const ReducedSystem wheel = damped_wheel();
  const FloatingBody floating = floating_body(wheel, with_dampers());
  const MatrixXd C = 1e-5 * floating.body.omega.cwiseAbs2().asDiagonal().toDenseMatrix();
  EXPECT_LT((floating.body.C - C).norm(), 1e-9 * C.norm());
  EXPECT_EQ(refused_key(wheel, with_dampers({"hub"})), "");
}

// A damper across the rim damps nothing but for what products of round-off leave.
TEST(FloatingBody, TakesRoundOffForNoDamperToTheGround)
{
  ReducedSystem wheel = test::wheel();
  wheel.C = MatrixXd::Zero(wheel.K.rows(), wheel.K.cols());
  const int a = 0, b = 6 * test::wheel_rim_nodes / 2;  // x of opposite nodes
  wheel.C(a, a) = wheel.C(b, b) = 1e3;
  wheel.C(a, b) = wheel.C(b, a) = -1e3;
  wheel.C(3, 3) = 1e-30;
  EXPECT_EQ(refused_key(wheel, with_dampers()), "");
  wheel.C(a, a) = 1e3 * (1.0 + 1e-11);  // a share of 3e-12 of the sum without signs
  EXPECT_EQ(refused_key(wheel, with_dampers()), "");
  wheel.C(a, a) = 1e3 * (1.0 + 1e-8);
  EXPECT_EQ(refused_key(wheel, with_dampers()), "spring.damping");
}

TEST(FloatingBody, RefusesDampersToTheGround)
{
  for (const int dof : {0, 1, 2, 3, 4, 5}) {
    ReducedSystem wheel = damped_wheel();
    wheel.C(dof, dof) += dof < 3 ? 7.5 : 1e-3;
    EXPECT_EQ(refused_key(wheel, with_dampers()), "spring.damping") << dof;
    EXPECT_EQ(refused_key(wheel, with_dampers({"hub"})), "spring.damping") << dof;
  }
  ReducedSystem wheel = test::wheel();
  wheel.C = MatrixXd::Zero(wheel.K.rows(), wheel.K.cols());
  EXPECT_EQ(refused_key(wheel, with_dampers()), "");
  wheel.C(2, 2) = 1e-9;
  EXPECT_EQ(refused_key(wheel, with_dampers()), "spring.damping");
}

/// P / sqrt(m) of a motion of unit modal mass is the part of it that the centre of mass moves with,
/// and L / sqrt(J) the part of a rotation: the larger one couples to the frame.
TEST(FloatingBody, IsCoupledByItsMomentumOrByItsAngularMomentum)
{
  FloatingBody floating{};
  floating.body.omega = Eigen::Vector2d(10.0, 20.0);
  floating.body.mass = 4.0;
  floating.body.centre_of_mass = {0.0, 1.0, 0.0};
  floating.body.inertia = Eigen::Vector3d(1.0, 2.0, 2.0).asDiagonal();  // trace 5, and 4 * 1^2
  floating.momentum = MatrixXd::Zero(3, 2);
  floating.angular_momentum = MatrixXd::Zero(3, 2);
  EXPECT_EQ(coupling(floating), 0.0);
  floating.momentum.col(1) << 0.6, 0.0, 0.8;
  EXPECT_NEAR(coupling(floating), 0.5, 1e-15);
  floating.angular_momentum.col(0) << 0.0, 0.3, 0.0;
  EXPECT_NEAR(coupling(floating), 0.5, 1e-15);
  floating.angular_momentum.col(0) << 0.0, 0.0, 2.7;
  EXPECT_NEAR(coupling(floating), 0.9, 1e-15);
}

TEST(FloatingBody, MayLeaveDampersOut)
{
  ReducedSystem wheel = damped_wheel();
  wheel.C(2, 2) += 7.5;
  BodyOptions options;
  EXPECT_EQ(floating_body(wheel, options).body.C.size(), 0);
  options.damping = {.type = Damping::Type::modal, .ratios = {0.01}};
  EXPECT_EQ(refused_key(wheel, options), "");
}

TEST(FloatingBody, TellsSpringsToTheGroundFromMissingMasters)
{
  ReducedSystem wheel = test::wheel();
  wheel.K(2, 2) += 1e6;
  EXPECT_EQ(refused_key(wheel, {}), "spring.stiffness");
  EXPECT_EQ(refused_key(test::reduced_beam(12, 3), {}), "interface.nodes");
}

}  // namespace
}  // namespace chladni::mbs_export::formats
