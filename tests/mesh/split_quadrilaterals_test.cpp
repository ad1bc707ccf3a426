#include "mesh/mesh_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "surface.hpp"

namespace chladni::mesh {
namespace {

/// One quadrilateral of order 2 whose corner `flat` lies on the line between its neighbours.
Mesh flat_quadrilateral(int flat)
{
  std::array<std::array<double, 2>, 4> corners{{{0, 0}, {2, 0}, {0, 2}, {2, 2}}};
  const std::array<int, 2> neighbours =
      flat == 0 || flat == 3 ? std::array{1, 2} : std::array{0, 3};
  for (std::size_t c = 0; c < 2; ++c)
    corners[flat][c] = 0.5 * (corners[neighbours[0]][c] + corners[neighbours[1]][c]);
  Mesh mesh;
  ElementBlock block{.shape = Shape::quadrilateral,
                     .order = 2,
                     .nodes_per_element = 9,
                     .numbers = {7},
                     .nodes = {},
                     .group = {0}};
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const double r = i / 2.0, s = j / 2.0;
      std::array<double, 3> x{};
      for (std::size_t c = 0; c < 2; ++c) {
        x[c] = (1 - r) * (1 - s) * corners[0][c] + r * (1 - s) * corners[1][c] +
               (1 - r) * s * corners[2][c] + r * s * corners[3][c];
      }
      block.nodes.push_back(mesh.n_nodes());
      mesh.node_numbers.push_back(mesh.n_nodes() + 1);
      mesh.positions.push_back(x);
    }
  }
  mesh.blocks.push_back(block);
  return mesh;
}

class SplitFlatCorners : public ::testing::TestWithParam<int> {};

TEST_P(SplitFlatCorners, HalvesTheFlatCornerIntoTwoTrianglesOfTheSameArea)
{
  const Mesh before = flat_quadrilateral(GetParam());
  const Mesh after = split_flat_corners(before);
  ASSERT_EQ(after.blocks.size(), 1u);
  const ElementBlock& triangles = after.blocks[0];
  EXPECT_EQ(triangles.shape, Shape::triangle);
  ASSERT_EQ(triangles.n_elements(), 2);
  EXPECT_EQ(triangles.numbers, (std::vector<std::int64_t>{7, 7}));
  double area = 0.0;
  for (int e = 0; e < 2; ++e) {
    const double a = testing::corner_area(after, triangles, e);
    EXPECT_GT(a, 0.5);  // neither is flat
    area += a;
  }
  EXPECT_DOUBLE_EQ(area, testing::corner_area(before, before.blocks[0], 0));
}

TEST_P(SplitFlatCorners, UseEachNodeOfTheQuadrilateral)
{
  const Mesh after = split_flat_corners(flat_quadrilateral(GetParam()));
  std::vector<int> used = after.blocks.at(0).nodes;
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  EXPECT_EQ(used.size(), 9u);
}

INSTANTIATE_TEST_SUITE_P(EachCorner, SplitFlatCorners, ::testing::Values(0, 1, 2, 3));

}  // namespace
}  // namespace chladni::mesh
