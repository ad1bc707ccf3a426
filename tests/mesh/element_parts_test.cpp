#include "mesh/element_types.hpp"

#include <gtest/gtest.h>

#include <set>

#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

/// 2 x 1 m of elements of 0.5 m.
Mesh plate_of(Pattern pattern, int order)
{
  return rectangle({.length = 2.0,
                    .width = 1.0,
                    .element_size = 0.5,
                    .element_order = order,
                    .pattern = pattern});
}

TEST(LatticeCells, OfAQuadrilateralAreAsManyAsItsIntervals)
{
  for (const int p : {1, 2, 3, 4}) {
    const Mesh mesh = plate_of(Pattern::structured, p);
    EXPECT_EQ(lattice_cells(mesh.blocks.at(0), 1).size(), std::size_t(p) * p);
    EXPECT_EQ(lattice_cells(mesh.blocks.at(0), p).size(), 1u);
  }
}

TEST(LatticeCells, OfATriangleCoverEachPlaceAndRepeatTheirLastCorner)
{
  for (const int p : {1, 2, 3}) {
    const Mesh mesh = plate_of(Pattern::triangles, p);
    const ElementBlock& block = mesh.blocks.at(0);
    ASSERT_EQ(block.shape, Shape::triangle);
    const auto cells = lattice_cells(block, 1);
    EXPECT_EQ(cells.size(), std::size_t(p) * p);
    std::set<int> places;
    for (const LatticeCell& cell : cells) {
      EXPECT_EQ(cell[2], cell[3]);
      places.insert(cell.begin(), cell.end());
    }
    EXPECT_EQ(places.size(), std::size_t(block.nodes_per_element));
  }
}

TEST(EdgesIn, AGroupAreThoseWithAllTheirNodesInIt)
{
  for (const int p : {1, 2, 3}) {
    const Mesh mesh = plate_of(Pattern::structured, p);
    const auto edges = edges_in(mesh, find_group(mesh, "bottom"));
    EXPECT_EQ(edges.size(), 4u);
    for (const auto& edge : edges) {
      EXPECT_EQ(edge.size(), std::size_t(p) + 1);
      for (const int node : edge) EXPECT_EQ(mesh.positions[node][1], 0.0);
    }
    EXPECT_TRUE(edges_in(mesh, find_group(mesh, "corners")).empty());
    // 4 x 2 elements; each inner edge counts once
    EXPECT_EQ(edges_in(mesh, find_group(mesh, "plate")).size(), 4u * 3u + 5u * 2u);
  }
}

}  // namespace
}  // namespace chladni::mesh
