#include "mesh/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/error.hpp"
#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

Mesh small_disc()
{
  return annulus({.inner_radius = 0.05,
                  .outer_radius = 0.1,
                  .element_size = 0.02,
                  .element_order = 2,
                  .rings = {}});
}

TEST(NodeOwners, GiveEachPartItsShare)
{
  const Mesh mesh = small_disc();
  for (const int n_parts : {1, 2, 3, 4}) {
    const std::vector<int> owners = node_owners(mesh, n_parts);
    ASSERT_EQ(std::ssize(owners), mesh.n_nodes());
    for (int part = 0; part < n_parts; ++part) {
      // Elements are balanced; nodes on an interface go to the lower part.
      EXPECT_GT(std::ranges::count(owners, part), mesh.n_nodes() / (2 * n_parts));
    }
  }
}

TEST(NodeOwners, AreTheSameOnEachCall)
{
  const Mesh mesh = small_disc();
  EXPECT_EQ(node_owners(mesh, 2), node_owners(mesh, 2));
}

TEST(NodeOwners, RefuseMorePartsThanElements)
{
  EXPECT_THROW(node_owners(small_disc(), 100000), Error);
}

}  // namespace
}  // namespace chladni::mesh
