#include "plate/dofs/drilling.hpp"

#include <gtest/gtest.h>

#include <string>

#include "common/error.hpp"
#include "coupled_models.hpp"
#include "plate/assembly/assemble.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/dofs/point_elements.hpp"

namespace chladni::plate {
namespace {

using testing::dofs_of;
using testing::map_of;
using testing::plate;

template <typename Part>
std::string error_of_check(const Part& check)
{
  try {
    check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// What is said of a mass, spring, load or support on the plate in the x-y plane; empty if nothing.
std::string complaint(const PointMass& mass)
{
  return error_of_check([&] {
    const mesh::Mesh mesh = plate();
    point_elements(mesh, {.masses = {&mass, 1}}, map_of(mesh, {}));
  });
}

std::string complaint(const Spring& spring)
{
  return error_of_check([&] {
    const mesh::Mesh mesh = plate();
    point_elements(mesh, {.springs = {&spring, 1}}, map_of(mesh, {}));
  });
}

std::string complaint(const NodalLoad& moment)
{
  return error_of_check([&] {
    const mesh::Mesh mesh = plate();
    const Load load = moment;
    refuse_drilling(mesh, map_of(mesh, {}), std::span(&load, 1));
  });
}

std::string complaint(const std::vector<Support>& supports)
{
  return error_of_check([&] {
    const mesh::Mesh mesh = plate();
    refuse_drilling(mesh, map_of(mesh, {}), supports, std::span<const Spring>());
  });
}

bool names_the_rotation(const std::string& text)
{
  return text.find("node ") != std::string::npos && text.find("rz") != std::string::npos &&
         text.find("couple") != std::string::npos;
}

TEST(DrillingAxes, AreTheNormalsOfAPlate)
{
  const mesh::Mesh mesh = plate();
  const Eigen::MatrixX3d axes = drilling_axes(mesh, map_of(mesh, {}));
  ASSERT_EQ(axes.rows(), mesh.n_nodes());
  for (Eigen::Index i = 0; i < axes.rows(); ++i) EXPECT_NEAR(std::abs(axes(i, 2)), 1.0, 1e-14);
}

TEST(DrillingAxes, EndWhereTheNodesHaveNoSuchRotation)
{
  const mesh::Mesh mesh = plate();
  EXPECT_TRUE(drilling_axes(mesh, dofs_of(mesh, {.components = {2, 3, 4}})).isZero(0.0));
}

TEST(DrillingAxes, EndWhereTheShellIsFolded)
{
  mesh::Mesh mesh = plate();  // what lies beyond its middle is turned up
  for (auto& x : mesh.positions)
    if (x[0] > 1.0) x = {1.0, x[1], x[0] - 1.0};
  const Eigen::MatrixX3d axes = drilling_axes(mesh, map_of(mesh, {}));
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const bool is_at_fold = mesh.positions[node][0] == 1.0 && mesh.positions[node][2] == 0.0;
    EXPECT_EQ(axes.row(node).isZero(0.0), is_at_fold) << node;
  }
}

TEST(DrillingAxes, OfSomeNodesAreTheirs)
{
  mesh::Mesh mesh = plate();
  for (auto& x : mesh.positions)
    if (x[0] > 1.0) x = {1.0, x[1], x[0] - 1.0};
  const DofMap dofs = map_of(mesh, {{.name = "foot", .group = "left"}});
  const Eigen::MatrixX3d all = drilling_axes(mesh, dofs);
  std::vector<int> nodes{*dofs.reference_node("foot"), mesh.n_nodes() - 1};
  for (int node = 0; node < mesh.n_nodes(); node += 3) nodes.push_back(node);
  const Eigen::MatrixX3d some = drilling_axes(mesh, dofs, nodes);
  ASSERT_EQ(some.rows(), std::ssize(nodes));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    EXPECT_EQ(some.row(Eigen::Index(i)), all.row(nodes[i])) << nodes[i];
  EXPECT_EQ(drilling_axes(mesh, dofs, {}).rows(), 0);
}

TEST(DrillingAxes, EndWhereOtherNodesFollow)
{
  const mesh::Mesh mesh = plate();
  const DofMap dofs = map_of(mesh, {{.name = "foot", .group = "left"}});
  const Eigen::MatrixX3d axes = drilling_axes(mesh, dofs);
  ASSERT_EQ(axes.rows(), dofs.n_nodes());
  EXPECT_TRUE(axes.row(*dofs.reference_node("foot")).isZero(0.0));
  for (const int node : mesh::find_group(mesh, "left").nodes)
    EXPECT_TRUE(axes.row(node).isZero(0.0));
}

TEST(DrillingAxes, EndAtANodeOfTheShellThatOthersFollow)
{
  // What the followers bend resists the turn of the node that they follow about its normal.
  const mesh::Mesh mesh = plate();
  const DofMap dofs = map_of(mesh, {testing::link("corner", "centre")});
  const Eigen::MatrixX3d axes = drilling_axes(mesh, dofs);
  const int followed = mesh::find_group(mesh, "centre").nodes.front();
  ASSERT_FALSE(dofs.is_dependent(followed));
  EXPECT_TRUE(axes.row(followed).isZero(0.0));
  EXPECT_FALSE(drilling_axes(mesh, map_of(mesh, {})).row(followed).isZero(0.0));
  const PointMass flywheel{"centre", 1.0, {0, 0, 1e-3}};
  EXPECT_EQ(error_of_check([&] { point_elements(mesh, {.masses = {&flywheel, 1}}, dofs); }), "");
  EXPECT_TRUE(names_the_rotation(complaint(flywheel)));
}

TEST(Drilling, IsNoPlaceForInertia)
{
  EXPECT_TRUE(names_the_rotation(complaint(PointMass{"corner", 1.0, {0, 0, 1e-3}})));
  EXPECT_TRUE(
      names_the_rotation(complaint(PointMass{.at = "corner", .mass = 1.0, .offset = {0.1, 0, 0}})));
  EXPECT_EQ(complaint(PointMass{"corner", 1.0, {1e-3, 1e-3, 0}}), "");
  EXPECT_EQ(complaint(PointMass{.at = "corner", .mass = 1.0, .offset = {0, 0, 0.1}}), "");
  // A mass on an arm that leans by the angle a has sin(a)^2 / 2 of its inertia about the normal,
  // which is as exact as 0.01 rad.
  for (const double a : {0.002, 0.01})
    EXPECT_EQ(complaint(PointMass{.at = "corner", .mass = 1.0, .offset = {0.1 * a, 0, 0.1}}), "");
  for (const double a : {0.02, 0.1}) {
    EXPECT_TRUE(names_the_rotation(
        complaint(PointMass{.at = "corner", .mass = 1.0, .offset = {0.1 * a, 0, 0.1}})));
  }
}

TEST(Drilling, IsNoPlaceForSprings)
{
  EXPECT_TRUE(
      names_the_rotation(complaint(Spring{.at = "corner", .stiffness = {0, 0, 1, 0, 0, 5}})));
  EXPECT_TRUE(names_the_rotation(complaint(Spring{.at = "left", .damping = {0, 0, 0, 0, 0, 5}})));
  EXPECT_TRUE(names_the_rotation(
      complaint(Spring{.at = "centre", .to = "corner", .stiffness = {0, 0, 0, 0, 0, 5}})));
  EXPECT_EQ(complaint(Spring{.at = "corner", .stiffness = {1, 1, 1, 1, 1, 0}}), "");
}

TEST(Drilling, IsNoPlaceForMoments)
{
  EXPECT_TRUE(names_the_rotation(complaint(NodalLoad{.group = "right", .moment = {0.5, 0, 0.1}})));
  EXPECT_EQ(complaint(NodalLoad{.group = "right", .force = {1, 1, 1}, .moment = {0.5, 1, 0}}), "");
}

TEST(Drilling, DoesNotHoldABody)
{
  const std::vector<int> all{0, 1, 2, 3, 4, 5};
  EXPECT_TRUE(names_the_rotation(complaint({Support{"corner", all}})));
  EXPECT_EQ(complaint({Support{"left", all}}), "");
  EXPECT_EQ(complaint({Support{"corner", all}, Support{"left", {1}}}), "");
  EXPECT_EQ(complaint({Support{"corner", {0, 1, 2, 3, 4}}}), "");  // free, and says so
}

}  // namespace
}  // namespace chladni::plate
