#include "plate/dofs/dof_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/error.hpp"
#include "small_disc.hpp"

namespace chladni::plate {
namespace {

TEST(DofMap, NumbersTheNodesOfEachRankInOneRange)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<int> owners = mesh::node_owners(mesh, 3);
  const DofMap map = make_dof_map(mesh, {.couplings = testing::hub}, owners, 3);
  std::vector<int> seen(map.n_active(), 0);
  for (int node = 0; node < map.n_nodes(); ++node) {
    if (map.is_dependent(node)) continue;
    ++seen[map.number(node)];
    if (node < mesh.n_nodes()) {
      EXPECT_GE(map.number(node), map.first_number(owners[node]));
      EXPECT_LT(map.number(node), map.first_number(owners[node] + 1));
    }
  }
  EXPECT_EQ(std::ranges::count(seen, 1), map.n_active());
}

TEST(DofMap, PutsTheReferenceNodeInTheCentreOfItsGroup)
{
  const mesh::Mesh mesh = testing::small_disc();
  const DofMap map = make_dof_map(mesh, {.couplings = testing::hub}, mesh::node_owners(mesh, 1), 1);
  const auto reference = map.reference_node("hub");
  ASSERT_TRUE(reference.has_value());
  // Gmsh puts the nodes at equal angles to 1e-11 of the radius.
  for (const double x : map.position(*reference)) EXPECT_NEAR(x, 0.0, 1e-12);
}

TEST(DofMap, PutsTheReferenceNodeWhereTheCouplingSays)
{
  const mesh::Mesh mesh = testing::small_disc();
  for (const CouplingKind kind : {CouplingKind::rigid, CouplingKind::averaging}) {
    const std::vector<Coupling> away{
        {.name = "hub", .group = "inner_edge", .kind = kind, .at = {{0.1, -0.2, 0.3}}}};
    const DofMap map = make_dof_map(mesh, {.couplings = away}, mesh::node_owners(mesh, 1), 1);
    EXPECT_EQ(map.position(map.reference_node("hub").value()), Eigen::Vector3d(0.1, -0.2, 0.3));
  }
}

/// With `to` all nodes follow the one node of a group, or the reference node of a coupling.
TEST(DofMap, LetsAGroupFollowOneNode)
{
  mesh::Mesh mesh = testing::small_disc();
  const int leader = mesh::find_group(mesh, "outer_edge").nodes.front();
  mesh.groups.push_back({.name = "leader", .dimension = 0, .nodes = {leader}});
  const std::vector<Coupling> links{{.name = {}, .group = "track", .to = "hub"},
                                    {.name = "hub", .group = "leader"},
                                    {.name = {}, .group = "inner_edge", .to = "leader"}};
  const DofMap map = make_dof_map(mesh, {.couplings = links}, mesh::node_owners(mesh, 1), 1);
  const int hub = map.reference_node("hub").value();
  for (const char* group : {"track", "inner_edge", "leader"})
    for (const int node : mesh::find_group(mesh, group).nodes)
      EXPECT_EQ(map.reference(node), hub) << group << ", at the end of its chain";
}

TEST(DofMap, RefusesAMeanThatItsOwnNodesFollow)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling> circle{
      {.name = "pad", .group = "track", .kind = CouplingKind::averaging},
      {.name = {}, .group = "track", .to = "pad"}};
  try {
    make_dof_map(mesh, {.couplings = circle}, mesh::node_owners(mesh, 1), 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("follows the mean \"pad\""), std::string::npos)
        << error.what();
  }
}

TEST(DofMap, NamesANodeThatTwoCouplingsClaim)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling> twice{{"hub", "inner_edge"}, {"other", "inner_edge"}};
  EXPECT_THROW(make_dof_map(mesh, {.couplings = twice}, mesh::node_owners(mesh, 1), 1), Error);
}

TEST(DofMap, RefusesACouplingNamedAsAGroup)
{
  const mesh::Mesh mesh = testing::small_disc();
  const std::vector<Coupling> clash{{"disc", "inner_edge"}};
  EXPECT_THROW(make_dof_map(mesh, {.couplings = clash}, mesh::node_owners(mesh, 1), 1), Error);
}

}  // namespace
}  // namespace chladni::plate
