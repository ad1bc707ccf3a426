#include "mbs_export/loaded_dofs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "bending_beam.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "wheel.hpp"

namespace chladni::mbs_export {
namespace {

using Eigen::Index, Eigen::MatrixXd;

LoadedDofs loads_of(const ReducedSystem& reduced, const std::vector<std::string>& fixed,
                    const std::vector<InterfaceModes>& wanted)
{
  return loaded_dofs(reduced, held_dofs(reduced, fixed), wanted);
}

InterfaceModes frm_of(const std::string& at, const std::vector<int>& components)
{
  return {.kind = InterfaceModes::Kind::frm, .at = at, .components = components, .omega0 = {}};
}

MatrixXd all_patterns(const LoadedDofs& loads)
{
  MatrixXd P(Index(loads.dofs.size()), 0);
  for (const LoadGroup& group : loads.groups) {
    P.conservativeResize(Eigen::NoChange, P.cols() + group.patterns.cols());
    P.rightCols(group.patterns.cols()) = group.patterns;
  }
  return P;
}

TEST(LoadedDofs, OfARingAreItsDisplacementsNormalToTheDisc)
{
  const ReducedSystem wheel = test::wheel();
  const LoadedDofs loads = loads_of(wheel, {"hub"}, {});
  EXPECT_EQ(loads.names, std::vector<std::string>{"rim.z"});
  ASSERT_EQ(loads.dofs.size(), 12u);
  for (const int dof : loads.dofs) EXPECT_EQ(dof % 6, 2);
  ASSERT_EQ(loads.groups.size(), 7u);  // 0 to 6 diameters
  EXPECT_EQ(loads.groups[3].name, "rim.z, 3 diameters");
  EXPECT_EQ(loads.groups[3].patterns.cols(), 2);
  EXPECT_EQ(loads.groups[6].patterns.cols(), 1);
}

TEST(LoadedDofs, OfOtherSetsAreAllThatIsNotHeld)
{
  const LoadedDofs loads = loads_of(test::regression_beam(), {"A", "C.z"}, {});
  EXPECT_EQ(loads.names, (std::vector<std::string>{"B.z", "B.ry", "C.ry"}));
  EXPECT_EQ(loads.dofs, (std::vector<int>{8, 10, 16}));
  EXPECT_EQ(loads.is_moment, (std::vector<char>{0, 1, 1}));
  EXPECT_EQ(loads.groups[2].patterns, (Eigen::Vector3d(0.0, 0.0, 1.0)));
}

TEST(LoadedDofs, SpanTheSameLoadsInHarmonicsAsInNodes)
{
  ReducedSystem wheel = test::wheel();
  // Turned by half a node, cos(6 phi) is zero at all twelve nodes.
  const double half = std::numbers::pi / test::wheel_rim_nodes;
  for (const double angle : {0.0, half}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (AttachmentNode& node : wheel.attachment_nodes) node.position = turn * node.position;
    const LoadedDofs loads = loads_of(wheel, {"hub"}, {frm_of("rim", {0, 1, 2})});
    ASSERT_EQ(loads.dofs.size(), 36u);
    const MatrixXd P = all_patterns(loads);
    ASSERT_EQ(P.cols(), 36);
    EXPECT_LT((P.transpose() * P - MatrixXd::Identity(36, 36)).norm(), 1e-13);  // round-off
  }
}

TEST(LoadedDofs, TurnsTheForcesInThePlaneOfARingIntoEachOther)
{
  // A group of x and y must hold its own image when the wheel is turned by one node.
  const LoadedDofs loads = loads_of(test::wheel(), {"hub"}, {frm_of("rim", {0, 1})});
  const double angle = 2.0 * std::numbers::pi / test::wheel_rim_nodes;
  MatrixXd turn = MatrixXd::Zero(24, 24);
  for (int i = 0; i < 12; ++i) {
    const int next = (i + 1) % 12;
    turn(next, i) = turn(12 + next, 12 + i) = std::cos(angle);
    turn(12 + next, i) = std::sin(angle);
    turn(next, 12 + i) = -std::sin(angle);
  }
  for (const LoadGroup& group : loads.groups) {
    const MatrixXd turned = turn * group.patterns;
    const MatrixXd& P = group.patterns;
    EXPECT_LT((turned - P * (P.transpose() * turned)).norm(), 1e-13) << group.name;
  }
}

TEST(LoadedDofs, RefusesWhatCannotBeLoaded)
{
  const ReducedSystem wheel = test::wheel();
  const auto message = [&](const std::vector<std::string>& fixed,
                           const std::vector<InterfaceModes>& wanted) {
    return files::test::error_of([&] { loads_of(wheel, fixed, wanted); });
  };
  EXPECT_NE(message({"hub"}, {frm_of("hub", {2})}).find("hub.z is held"), std::string::npos);
  EXPECT_NE(message({"hub", "rim"}, {}).find("every attachment DOF is held"), std::string::npos);
  EXPECT_NE(message({"hub"}, {frm_of("track", {2})}).find("'rim', 'hub'"), std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
