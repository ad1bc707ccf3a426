#include "plate/dofs/free_motions.hpp"

#include <gtest/gtest.h>

#include "coupled_models.hpp"
#include "plate/dofs/dof_map.hpp"

namespace chladni::plate {
namespace {

using testing::dofs_of;
using testing::hub;
using testing::map_of;
using testing::plate;
using testing::small_disc;

const std::vector<int> all_components{0, 1, 2, 3, 4, 5};

TEST(FreeParts, FindTheSixMotionsOfAFreeBody)
{
  const mesh::Mesh disc = small_disc();
  const auto parts = free_parts(disc, map_of(disc, hub), {});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(n_free_motions(parts), 6);
}

TEST(FreeParts, NameWhatSupportsLeaveFree)
{
  const auto free = [](const std::vector<Support>& supports) {
    const mesh::Mesh mesh = plate();
    const DofMap dofs = map_of(mesh, {});
    return free_parts(mesh, dofs, held_dofs(mesh, dofs, supports));
  };
  EXPECT_TRUE(free({{.group = "left", .components = all_components}}).empty());
  EXPECT_TRUE(free({{.group = "corner", .components = all_components}}).empty());
  const auto in_plane = free({{.group = "left", .components = {2, 4}}});
  ASSERT_EQ(n_free_motions(in_plane), 3);
  EXPECT_EQ(describe_motions(in_plane[0]),
            "3 ways (translation along x, translation along y, rotation about z)");
  const auto hinged = free({{.group = "left", .components = {0, 1, 2}}});
  EXPECT_EQ(n_free_motions(hinged), 1);  // about the left edge
}

TEST(FreeParts, AreTheSameFarFromTheOrigin)
{
  mesh::Mesh mesh = plate();
  const auto free = [&] {
    const DofMap dofs = map_of(mesh, {});
    const std::vector<Support> hinges{{.group = "left", .components = {0, 1, 2}}};
    return free_parts(mesh, dofs, held_dofs(mesh, dofs, hinges));
  };
  const std::vector<FreePart> here = free();
  for (auto& x : mesh.positions) x[0] += 65536.0;
  const std::vector<FreePart> there = free();
  ASSERT_EQ(n_free_motions(there), 1);
  // A turn about the edge, which is 1 m from the centre, in the length 1 / (mean distance of it).
  const Eigen::VectorXd motion = here[0].motions.col(0);
  EXPECT_LT((there[0].motions * there[0].motions.transpose() - motion * motion.transpose()).norm(),
            1e-9);
  double length = 0.0;
  for (const auto& x : mesh.positions)
    length += std::hypot(x[0] - 65537.0, x[1] - 0.5) / mesh.n_nodes();
  EXPECT_NEAR(std::abs(motion[2] / motion[4]), 1.0 / length, 1e-9);
}

/// Two plates that nothing connects; the corner of the second has the group "far_corner".
mesh::Mesh two_plates()
{
  mesh::Mesh mesh = plate();
  const mesh::Mesh other = mesh;
  const int n = mesh.n_nodes();
  for (auto x : other.positions) mesh.positions.push_back({x[0] + 10.0, x[1], x[2]});
  for (const auto number : other.node_numbers) mesh.node_numbers.push_back(n + number);
  for (const int node : other.blocks[0].nodes) mesh.blocks[0].nodes.push_back(n + node);
  for (const auto number : other.blocks[0].numbers) mesh.blocks[0].numbers.push_back(12 + number);
  for (const int group : other.blocks[0].group) mesh.blocks[0].group.push_back(group);
  const int corner = mesh::find_group(other, "corner").nodes[0];
  mesh.groups.push_back({.name = "far_corner", .dimension = 0, .nodes = {n + corner}});
  return mesh;
}

TEST(FreeParts, FindAPartThatNothingConnects)
{
  const mesh::Mesh mesh = two_plates();
  const DofMap dofs = map_of(mesh, {});
  const auto parts = free_parts(
      mesh, dofs,
      held_dofs(mesh, dofs, std::vector<Support>{{.group = "left", .components = all_components}}));
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].n_nodes, mesh.n_nodes() / 2);
  EXPECT_NEAR(parts[0].centre.x(), 11.0, 1e-12);  // a mean of some hundred terms
}

Spring spring(const std::string& at, const std::array<double, 6>& stiffness,
              const std::optional<std::string>& to = {})
{
  return {.at = at, .to = to, .stiffness = stiffness};
}

TEST(FreeParts, AreHeldBySpringsHoweverSoft)
{
  const mesh::Mesh mesh = plate();
  const DofMap dofs = map_of(mesh, {});
  const auto n_free = [&](const std::vector<Spring>& springs) {
    return n_free_motions(free_parts(mesh, dofs, {}, springs));
  };
  constexpr double k = 1e-6;  // against 1e11 in K
  EXPECT_EQ(n_free({spring("corner", {k, k, k})}), 3);
  EXPECT_EQ(n_free({spring("corner", {k, k, k, k, k, k})}), 0);
  EXPECT_EQ(n_free({spring("left", {0, 0, k})}), 4);  // a line: one rotation is resisted
  EXPECT_EQ(n_free({spring("left", {0, 0, k}), spring("right", {0, 0, k})}), 3);
  EXPECT_EQ(n_free({spring("left", {k, k, k}), spring("right", {0, k, k})}), 0);
  EXPECT_EQ(n_free({{.at = "left", .damping = {1, 1, 1, 1, 1, 1}}}), 6);  // a damper holds nothing
}

TEST(FreeParts, OfPiecesThatASpringConnectsAreOneBody)
{
  const mesh::Mesh mesh = two_plates();
  const DofMap dofs = map_of(mesh, {});
  const auto free = [&](const std::array<double, 6>& stiffness) {
    return free_parts(mesh, dofs, {}, std::vector{spring("corner", stiffness, "far_corner")});
  };
  EXPECT_EQ(free({0, 0, 5}).size(), 1u);
  EXPECT_EQ(n_free_motions(free({0, 0, 5})), 11);
  EXPECT_EQ(n_free_motions(free({5, 5, 5})), 9);
  const auto joined = free({5, 5, 5, 5, 5, 5});
  EXPECT_EQ(joined[0].n_nodes, mesh.n_nodes());
  EXPECT_EQ(n_free_motions(joined), 6);
  EXPECT_NE(describe_motions(joined[0]).find("rotation about z"), std::string::npos);
}

TEST(FreeParts, KnowTheComponentsThatNodesDoNotHave)
{
  const mesh::Mesh mesh = plate();
  const DofMap dofs = dofs_of(mesh, {.components = {2, 3, 4}});
  const auto parts = free_parts(mesh, dofs, {});
  ASSERT_EQ(n_free_motions(parts), 3);
  EXPECT_EQ(describe_motions(parts[0]),
            "3 ways (translation along z, rotation about x, rotation about y)");
  const auto held =
      held_dofs(mesh, dofs, std::vector<Support>{{.group = "left", .components = {2}}});
  EXPECT_EQ(n_free_motions(free_parts(mesh, dofs, held)), 1);
}

TEST(StiffnessOfAllNodes, NamesANodeWithoutElement)
{
  mesh::Mesh mesh = plate();
  mesh.positions.push_back({0.0, 0.0, 1.0});
  mesh.node_numbers.push_back(4711);
  const std::vector<int> owners(mesh.n_nodes(), 0);
  const DofMap map = make_dof_map(mesh, {}, owners, 1);
  try {
    check_stiffness_of_all_nodes(mesh, map);
    FAIL() << "the node was not found";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("node 4711"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace chladni::plate
