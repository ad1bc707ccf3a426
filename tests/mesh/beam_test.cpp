#include <gtest/gtest.h>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh/partition.hpp"

namespace chladni::mesh {
namespace {

BeamMeshOptions slanted()
{
  return {.start = {1.0, 0.0, 0.0},
          .end = {1.0, 3.0, 4.0},
          .elements = 10,
          .element_size = {},
          .points = {{.name = "middle", .distance = 2.5}}};
}

TEST(BeamMesh, HasEqualElementsAndNamesItsEndsAndPoints)
{
  const Mesh mesh = beam(slanted());
  ASSERT_EQ(mesh.n_nodes(), 11);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].shape, Shape::line);
  EXPECT_EQ(mesh.blocks[0].n_elements(), 10);
  for (int e = 0; e < 10; ++e) {
    EXPECT_EQ(mesh.blocks[0].element_nodes(e)[0], e);
    EXPECT_EQ(mesh.blocks[0].element_nodes(e)[1], e + 1);
    EXPECT_EQ(mesh.groups[mesh.blocks[0].group[e]].name, "beam");
  }
  EXPECT_EQ(mesh.positions.back(), (std::array{1.0, 3.0, 4.0}));
  EXPECT_NEAR(mesh.positions[3][2], 1.2, 1e-15);
  EXPECT_EQ(find_group(mesh, "beam").nodes.size(), 11u);
  EXPECT_EQ(find_group(mesh, "start").nodes, std::vector<int>{0});
  EXPECT_EQ(find_group(mesh, "middle").nodes, std::vector<int>{5});
  EXPECT_EQ(find_group(mesh, "end").nodes, std::vector<int>{10});
}

TEST(BeamMesh, DividesEachPieceBetweenPointsByTheElementSize)
{
  BeamMeshOptions options = slanted();
  options.elements = {};
  options.element_size = 1.0;
  options.points = {{.name = "a", .distance = 2.1}, {.name = "b", .distance = 4.1}};
  const Mesh mesh = beam(options);
  // Pieces of 2.1, 2.0 and 0.9 m: three, two and one element.
  EXPECT_EQ(mesh.n_nodes(), 7);
  EXPECT_EQ(find_group(mesh, "a").nodes, std::vector<int>{3});
  EXPECT_EQ(find_group(mesh, "b").nodes, std::vector<int>{5});
  EXPECT_NEAR(mesh.positions[3][1], 2.1 * 0.6, 1e-15);
}

TEST(BeamMesh, RefusesAPointBetweenNodesAndABeamWithoutLength)
{
  BeamMeshOptions options = slanted();
  options.points[0].distance = 2.6;
  try {
    beam(options);
    FAIL() << "a point between nodes is accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"middle\" at 2.6 m"), std::string::npos);
  }
  options = slanted();
  options.end = options.start;
  EXPECT_THROW(beam(options), Error);
}

TEST(Beam, HasLinesOfAnOrderWithEquidistantNodesFromEndToEnd)
{
  BeamMeshOptions options = slanted();
  options.element_order = 3;
  const Mesh coarse = beam(slanted()), mesh = beam(options);
  const ElementBlock& lines = mesh.blocks.front();
  EXPECT_EQ(lines.order, 3);
  EXPECT_EQ(lines.n_elements(), coarse.blocks.front().n_elements());
  EXPECT_EQ(mesh.n_nodes(), 3 * (coarse.n_nodes() - 1) + 1);
  for (int e = 0; e < lines.n_elements(); ++e) {
    const std::span<const int> nodes = lines.element_nodes(e);
    ASSERT_EQ(std::ssize(nodes), 4);
    const auto& a = mesh.positions[static_cast<std::size_t>(nodes[0])];
    const auto& b = mesh.positions[static_cast<std::size_t>(nodes[3])];
    const auto& at = mesh.positions[static_cast<std::size_t>(nodes[1])];
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(at[c], (2.0 * a[c] + b[c]) / 3.0, 1e-14);
    if (e > 0) {
      EXPECT_EQ(nodes[0], lines.element_nodes(e - 1)[3]);
    }
  }
}

TEST(Partition, DividesABeamAmongRanksInPieces)
{
  const Mesh mesh = beam(slanted());
  const std::vector<int> owners = node_owners(mesh, 2);
  int changes = 0;
  for (std::size_t i = 1; i < owners.size(); ++i) changes += owners[i] != owners[i - 1];
  EXPECT_EQ(changes, 1);  // neighbours stay together
}

}  // namespace
}  // namespace chladni::mesh
