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
