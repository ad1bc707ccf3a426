// Links and chains of couplings, and what stands at the nodes that they move.
#include "plate/dofs/couplings.hpp"

#include <gtest/gtest.h>

#include <set>

#include "coupled_models.hpp"
#include "plate/assembly/recovery.hpp"
#include "plate/dofs/free_motions.hpp"
#include "plate/dofs/point_elements.hpp"

namespace chladni::plate {
namespace {

using testing::average;
using testing::disc_system;
using testing::energy;
using testing::error_of;
using testing::expect_words;
using testing::link;
using testing::map_of;
using testing::plate;
using testing::random_motion;

TEST(Links, FollowTheirNearestNodes)
{
  const mesh::Mesh mesh = plate();
  const DofMap map = map_of(mesh, {link("top", "bottom")});
  for (const int node : mesh::find_group(mesh, "top").nodes) {
    ASSERT_TRUE(map.is_dependent(node));
    EXPECT_EQ(map.arm(node), Eigen::Vector3d(0.0, 1.0, 0.0));
  }
}

TEST(Links, LeadThroughRigidCouplingsToTheirEnd)
{
  const mesh::Mesh mesh = plate();
  const DofMap map = map_of(mesh, {link("top", "bottom"), {.name = "base", .group = "bottom"}});
  for (const int node : mesh::find_group(mesh, "top").nodes) {
    EXPECT_EQ(map.reference(node), map.reference_node("base"));
    EXPECT_NEAR(map.arm(node)[1], 1.0, 1e-15);
  }
}

TEST(Links, NameBothCouplingsOfAConflict)
{
  const mesh::Mesh mesh = plate();
  expect_words(error_of(mesh, {link("top", "bottom"), {.name = "base", .group = "top"}}),
               {"two couplings", "link of \"top\" to \"bottom\"", "coupling \"base\""});
  expect_words(error_of(mesh, {link("top", "bottom"), link("bottom", "top")}),
               {"circle", "link of \"top\" to \"bottom\"", "link of \"bottom\" to \"top\""});
  expect_words(error_of(mesh, {link("right", "centre")}), {"both nearest", "pair"});
  expect_words(error_of(mesh, {link("corner", "top")}), {"belongs to both groups"});
  expect_words(error_of(mesh, {link("right", "rim")}), {"rim", "bottom"});
}

double part(const DofMap& map, int node, int component, int of_node, int of_component)
{
  const int number = map.number(of_node);
  double sum = 0.0;
  for (const MotionTerm& term : map.motion(node))
    if (term.number == number) sum += term.T(component, of_component);
  return sum;
}

/// u_x(0) = 2 u_y(1), u_y(1) = 3 theta_z(2), and what follows from both.
TEST(Equations, AreSolvedThroughEachOtherAndHoldOnlyOnce)
{
  mesh::Mesh mesh = plate();
  mesh.equations = {{"line 1", {{0, 0, 1.0}, {1, 1, -2.0}}},
                    {"line 2", {{1, 1, 0.5}, {2, 5, -1.5}}},
                    {"line 3", {{0, 0, 1.0}, {2, 5, -6.0}}}};
  const DofMap map = map_of(mesh, {});
  EXPECT_NEAR(part(map, 0, 0, 2, 5), 6.0, 1e-14);
  EXPECT_NEAR(part(map, 1, 1, 2, 5), 3.0, 1e-14);
  EXPECT_EQ(part(map, 0, 0, 1, 1), 0.0);
  EXPECT_EQ(part(map, 0, 1, 0, 1), 1.0) << "other components stay";
  const std::vector<int> unused = map.unused_dofs();
  EXPECT_EQ(std::set<int>(unused.begin(), unused.end()),
            (std::set{6 * map.number(0), 6 * map.number(1) + 1}));
  EXPECT_FALSE(map.dof(0, 0));
}

/// A support of a component that an equation is solved for.
TEST(Equations, AreHeldWhereWhatTheyAreSolvedByIs)
{
  mesh::Mesh mesh = plate();
  mesh.equations = {{"line 1", {{0, 0, 1.0}, {1, 0, -1.0}}}};
  mesh.groups.push_back({.name = "follows", .dimension = 0, .nodes = {0}});
  mesh.groups.push_back({.name = "leads", .dimension = 0, .nodes = {1}});
  const DofMap map = map_of(mesh, {});
  const std::vector<Support> one{{.group = "follows", .components = {0}}};
  EXPECT_THROW(held_dofs(mesh, map, one), Error);
  const std::vector<Support> both{one[0], {.group = "leads", .components = {0}}};
  EXPECT_EQ(held_dofs(mesh, map, both), (std::vector<int>{*map.dof(1, 0)}));
}

/// A node of no element has the components of its equations alone.
TEST(Equations, MayHaveANodeOfTheirOwn)
{
  mesh::Mesh mesh = plate();
  const int node = mesh.n_nodes();
  mesh.positions.push_back({9.0, 9.0, 9.0});
  mesh.node_numbers.push_back(999);
  mesh.equations = {{"line 1", {{0, 0, 1.0}, {node, 0, -1.0}}}};
  const DofMap map = map_of(mesh, {});
  EXPECT_EQ(part(map, 0, 0, node, 0), 1.0);
  EXPECT_EQ(part(map, node, 0, node, 0), 1.0);
  EXPECT_EQ(part(map, node, 1, node, 1), 0.0);
  EXPECT_EQ(map.unused_dofs().size(), 1U + 5U);
  EXPECT_NO_THROW(check_stiffness_of_all_nodes(mesh, map));
}

TEST(PointElements, ActOnTheMotionOfAverages)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling> couplings{average("pad", "inner_edge"), link("track", "outer_edge")};
  const std::array<double, 6> k{1e9, 2e9, 3e9, 4e5, 5e5, 6e5}, c{1, 2, 3, 4, 5, 6};
  const PointMass mass{.at = "pad", .mass = 50.0, .inertia = {1, 2, 3}, .offset = {0, 0.1, 0.2}};
  const Spring ground{.at = "pad", .stiffness = k, .damping = c};
  const System plain = disc_system(mesh, couplings);
  const System with =
      assemble(mesh, {.shells = testing::section, .masses = {&mass, 1}, .springs = {&ground, 1}},
               map_of(mesh, couplings), PETSC_COMM_WORLD);
  const petsc::Vector q = random_motion(with);
  const int pad = with.dofs.reference_node("pad").value();
  const Eigen::Vector<double, 6> u = node_motions(with.dofs, q).row(pad);
  const auto of = [&](const std::array<double, 6>& d) {
    return u.dot(Eigen::Map<const Eigen::Vector<double, 6>>(d.data()).asDiagonal() * u);
  };
  // Differences of sums whose terms are larger: K of the disc has entries of 1e11.
  EXPECT_NEAR((energy(with.K, q) - energy(plain.K, q)) / of(k), 1.0, 1e-6);
  EXPECT_NEAR((energy(with.M, q) - energy(plain.M, q)) / u.dot(point_mass_matrix(mass) * u), 1.0,
              1e-10);
  EXPECT_NEAR(energy(with.C, q) / of(c), 1.0, 1e-10);
}

}  // namespace
}  // namespace chladni::plate
