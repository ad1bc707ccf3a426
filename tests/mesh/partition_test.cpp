#include "mesh/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh/nodal_matrices.hpp"

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

TEST(NodeOwners, OfMatricesCutFewOfTheirBlocks)
{
  // A chain of two strings side by side, whose rungs come first.
  constexpr int n = 60;
  NodalMatrices matrices;
  const auto couple = [&](int a, int b) {
    matrices.K.push_back({.row = 6 * a, .column = 6 * b, .value = -1.0});
  };
  for (int i = 0; i < n; ++i) {
    couple(i, i);
    if (i % 2 == 0) couple(i, i + 1);
    if (i + 2 < n) couple(i, i + 2);
  }
  Mesh mesh;
  mesh.positions.resize(n);
  mesh.matrices = std::make_shared<const NodalMatrices>(matrices);
  EXPECT_EQ(node_owners(mesh, 1), std::vector<int>(n, 0));
  const std::vector<int> owners = node_owners(mesh, 2);
  ASSERT_EQ(owners.size(), std::size_t(n));
  EXPECT_NEAR(double(std::ranges::count(owners, 0)), 30.0, 3.0);
  int n_cut = 0;
  for (const MatrixEntry& entry : matrices.K)
    n_cut += owners[std::size_t(entry.row / 6)] != owners[std::size_t(entry.column / 6)] ? 1 : 0;
  EXPECT_LE(n_cut, 4) << "two strings, and at most two of the rungs";
}

}  // namespace
}  // namespace chladni::mesh
