#include "mbs_export/loaded_dofs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
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

/// Nodes on a line, all of whose DOFs are masters.
ReducedSystem nodes_on_a_line(int n)
{
  ReducedSystem line;
  line.sets.push_back({.name = "edge", .nodes = {}});
  for (int i = 0; i < n; ++i) {
    line.attachment_nodes.push_back({.number = i + 1, .position = {0.3, double(i) / n, 0.1}});
    line.sets[0].nodes.push_back(i);
    for (int c = 0; c < 6; ++c) line.masters.push_back({.node = i, .component = c});
  }
  return line;
}

TEST(LoadedDofs, OfManyNodesAreLoadedTogetherByPolynomials)
{
  // 6 components of 50 nodes are 300 DOFs; on a line there are 9 polynomials up to degree 8.
  const int n = 50;
  const LoadedDofs loads = loads_of(nodes_on_a_line(n), {}, {});
  ASSERT_EQ(loads.dofs.size(), 300u);
  ASSERT_EQ(loads.spread.cols(), 54);
  EXPECT_EQ(loads.names.front(), "edge.x of degree 8");
  EXPECT_EQ(std::ranges::count(loads.is_moment, 1), 27);
  EXPECT_EQ(loads.groups.size(), 54u);
  const MatrixXd& S = loads.spread;
  EXPECT_LT((S.transpose() * S - MatrixXd::Identity(54, 54)).norm(), 1e-12);
  Eigen::VectorXd eighth = Eigen::VectorXd::Zero(300), ninth = eighth;
  for (std::size_t i = 0; i < loads.dofs.size(); ++i) {
    const double y = double(loads.dofs[i] / 6) / n;
    if (loads.dofs[i] % 6 == 2) eighth[Index(i)] = std::pow(y, 8), ninth[Index(i)] = std::pow(y, 9);
  }
  const auto outside = [&](const Eigen::VectorXd& f) {
    return (f - S * loads.worked_on(f)).norm() / f.norm();
  };
  EXPECT_LT(outside(eighth), 1e-12);
  EXPECT_GT(outside(ninth), 1e-7);
}

TEST(LoadedDofs, OfManyNodesOnASurfaceHaveALowerDegree)
{
  ReducedSystem face = nodes_on_a_line(50);
  for (std::size_t i = 0; i < face.attachment_nodes.size(); ++i)
    face.attachment_nodes[i].position[2] = std::cos(7.0 * double(i));
  const LoadedDofs loads = loads_of(face, {}, {});
  // Degree 4: 15 fields for each of 6 components; degree 5 would be 126 loads.
  EXPECT_EQ(loads.spread.cols(), 6 * 15);
  EXPECT_EQ(loads.names.back(), "edge.rz of degree 4");
}

TEST(LoadedDofs, OfAnEdgeAreSpreadBesideThoseOfARing)
{
  const int n = 50, n_ring = 40;
  ReducedSystem both = nodes_on_a_line(n);
  both.sets.push_back({.name = "track", .nodes = {}});
  for (int i = 0; i < n_ring; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n_ring;
    both.attachment_nodes.push_back(
        {.number = n + i + 1, .position = {std::cos(angle), std::sin(angle), 0.0}});
    both.sets[1].nodes.push_back(n + i);
    for (int c = 0; c < 6; ++c) both.masters.push_back({.node = n + i, .component = c});
  }
  const LoadedDofs loads = loads_of(both, {}, {});
  EXPECT_EQ(loads.names.back(), "track.z");
  ASSERT_EQ(loads.spread.cols(), 54 + n_ring);
  EXPECT_EQ(loads.spread.rightCols(n_ring).cwiseAbs().colwise().sum().minCoeff(), 1.0);
  // Its harmonics are groups as without the edge.
  EXPECT_EQ(loads.groups.back().name, "track.z, 20 diameters");
  // The scene may name each node of the edge.
  const LoadedDofs named = loads_of(both, {}, {frm_of("edge", {0, 1, 2})});
  EXPECT_EQ(named.dofs.size(), 150u);
  EXPECT_EQ(named.spread.size(), 0);
}

TEST(LoadedDofs, OfFewNodesAreEachByItself)
{
  for (const int n : {16, 20, 24}) {  // bolts are as many
    const LoadedDofs loads = loads_of(nodes_on_a_line(n), {}, {});
    EXPECT_EQ(loads.spread.size(), 0);
    EXPECT_EQ(std::ssize(loads.is_moment), 6 * n);
  }
}

TEST(LoadedDofs, OfASetAreWhereItIsNotHeld)
{
  ReducedSystem line = nodes_on_a_line(5);
  line.sets.push_back({.name = "end", .nodes = {4}});
  const LoadedDofs loads = loads_of(line, {"end.x", "end.z", "edge.rx"}, {});
  EXPECT_EQ(loads.dofs.size(), 4u + 4 + 5 + 5 + 5);
  EXPECT_EQ(std::ranges::count(loads.dofs, 6 * 4 + 2), 0);
  EXPECT_EQ(std::ranges::count(loads.dofs, 6 * 4 + 1), 1);
  EXPECT_EQ(loads.names.front(), "edge.x");
}

TEST(LoadedDofs, AreNoneWhereTheSupportHoldsAll)
{
  EXPECT_TRUE(loads_of(test::wheel(), {"hub", "rim"}, {}).dofs.empty());
}

TEST(LoadedDofs, AreRefusedWhereWhatIsFreeIsDrillingAtSomeNodesAlone)
{
  ReducedSystem wheel = test::wheel();
  const std::vector<std::string> held{"hub", "rim.x", "rim.y", "rim.z", "rim.rx", "rim.ry"};
  EXPECT_EQ(loads_of(wheel, held, {}).names, std::vector<std::string>{"rim.rz"});
  const std::vector<int> rim = wheel.sets.front().nodes;
  wheel.attachment_nodes[std::size_t(rim[0])].drilling_axis = {0.0, 0.0, 1.0};
  const std::string said = files::test::error_of([&] { loads_of(wheel, held, {}); });
  const auto second = wheel.attachment_nodes[std::size_t(rim[1])].number;
  EXPECT_NE(said.find("rim.rz is free at node " + std::to_string(second) + ", but nothing"),
            std::string::npos)
      << said;
  for (const int node : rim) wheel.attachment_nodes[std::size_t(node)].drilling_axis = {0, 0, 1};
  EXPECT_TRUE(loads_of(wheel, held, {}).dofs.empty()) << "a moment there turns its node alone";
}

TEST(LoadedDofs, OfARingThatIsHeldAlongZAreThoseOfAnySet)
{
  const ReducedSystem wheel = test::wheel();
  const LoadedDofs found = loads_of(wheel, {"hub", "rim.z"}, {});
  EXPECT_GT(found.dofs.size(), 0u);
  for (const std::string& name : found.names) EXPECT_EQ(name.find("rim.z"), std::string::npos);
  EXPECT_EQ(loads_of(wheel, {"hub", "rim.z"}, {frm_of("rim", {0})}).dofs.size(), 12u);
  EXPECT_EQ(loads_of(wheel, {"hub"}, {}).dofs.size(), 12u) << "along z alone where that is free";
}

/// As a file with so many digits has them.
ReducedSystem with_six_digits(ReducedSystem system)
{
  for (AttachmentNode& node : system.attachment_nodes)
    node.position = (node.position * 1e6).array().round() * 1e-6;
  return system;
}

TEST(LoadedDofs, OfAnObliqueEdgeAreNoRoundOffOfItsCoordinates)
{
  ReducedSystem line = nodes_on_a_line(50);
  for (AttachmentNode& node : line.attachment_nodes)
    node.position = Eigen::Vector3d(0.3, 0.2, 0.1) * node.position.y();
  EXPECT_EQ(loads_of(with_six_digits(line), {}, {}).spread.cols(), 54);
  // On a bow of another hundredth, or a part of it, too: fields repeat those on the line.
  for (const double height : {1e-5, 1e-4, 1e-3, 1e-2}) {
    for (AttachmentNode& node : line.attachment_nodes) {
      const double t = node.position.x() / 0.3;
      node.position.z() = height * t * (1.0 - t);
    }
    const ReducedSystem rounded = with_six_digits(line);
    const LoadedDofs exact = loads_of(line, {}, {}), given = loads_of(rounded, {}, {});
    ASSERT_EQ(exact.spread.cols(), given.spread.cols()) << height;
    EXPECT_EQ(exact.names, given.names);
    const MatrixXd left = given.spread - exact.spread * (exact.spread.transpose() * given.spread);
    EXPECT_LT(left.colwise().norm().maxCoeff(), 0.05) << height;
  }
}

TEST(LoadedDofs, OfARoundEdgeAreItsHarmonics)
{
  // An uneven circle is no contact ring; with 48 nodes its 6 components are 288 DOFs.
  ReducedSystem circle = nodes_on_a_line(48);
  for (AttachmentNode& node : circle.attachment_nodes) {
    const double angle = 2.0 * std::numbers::pi * node.position.y(),
                 t = angle + 0.1 * std::sin(angle);
    node.position = {0.1 * std::cos(t), 0.1 * std::sin(t), 0.02};
  }
  const LoadedDofs loads = loads_of(with_six_digits(circle), {}, {});
  EXPECT_EQ(loads.names.front(), "edge.x of degree 7");
  EXPECT_EQ(loads.spread.cols(), 6 * 15);
}

TEST(LoadedDofs, RefusesWhatCannotBeLoaded)
{
  const ReducedSystem wheel = test::wheel();
  const auto message = [&](const std::vector<std::string>& fixed,
                           const std::vector<InterfaceModes>& wanted) {
    return files::test::error_of([&] { loads_of(wheel, fixed, wanted); });
  };
  EXPECT_NE(message({"hub"}, {frm_of("hub", {2})}).find("hub.z is held"), std::string::npos);
  EXPECT_NE(message({"hub"}, {frm_of("track", {2})}).find("'rim', 'hub'"), std::string::npos);
}

}  // namespace
}  // namespace chladni::mbs_export
