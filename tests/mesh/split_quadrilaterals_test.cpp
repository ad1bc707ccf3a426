#include "mesh/mesh_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
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

TEST(FlatCorners, AreThoseOfMoreThan165Degrees)
{
  const auto n_elements = [](double degrees) {  // of a kite whose upper corner has this angle
    const double half = 0.5 * degrees * std::numbers::pi / 180.0;
    Mesh mesh;
    mesh.positions = {{0, -1, 0}, {std::sin(half), 0, 0}, {-std::sin(half), 0, 0}};
    mesh.positions.push_back({0, std::cos(half), 0});
    mesh.node_numbers = {1, 2, 3, 4};
    mesh.blocks = {{.shape = Shape::quadrilateral,
                    .order = 1,
                    .nodes_per_element = 4,
                    .numbers = {1},
                    .nodes = {0, 1, 2, 3},
                    .group = {-1}}};
    return split_flat_corners(mesh).blocks.at(0).n_elements();
  };
  EXPECT_EQ(n_elements(164.9), 1);
  EXPECT_EQ(n_elements(165.1), 2);
}

/// Two triangles with the longest sides of 3 and 4, whose slanted sides lie this far apart.
Mesh triangles_apart(double gap)
{
  Mesh mesh;
  mesh.positions = {{2, 2, 0}, {-1, 2, 0}, {2, -2, 0}, {-1, 2, gap}, {2, -2, gap}, {-1, -2, gap}};
  mesh.node_numbers = {11, 12, 13, 14, 15, 16};
  mesh.groups = {{.name = "side", .dimension = 1, .nodes = {1, 2, 3, 4}}};
  mesh.blocks = {{.shape = Shape::triangle,
                  .order = 1,
                  .nodes_per_element = 3,
                  .numbers = {1, 2},
                  .nodes = {0, 1, 2, 3, 4, 5},
                  .group = {-1, -1}}};
  return mesh;
}

std::string refusal_of(const Mesh& mesh, const MeshOptions& options = {})
{
  try {
    treat_coincident_nodes(mesh, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CoincidentNodes, LieWithinAMillionthOfTheExtentAndATenthOfTheShortestSide)
{
  EXPECT_NE(refusal_of(triangles_apart(4.9e-6)).find("(within 5e-06 m): 12 and 14, 13 and 15;"),
            std::string::npos)
      << refusal_of(triangles_apart(4.9e-6));
  EXPECT_EQ(refusal_of(triangles_apart(5.1e-6)), "accepted");
  EXPECT_EQ(refusal_of(triangles_apart(4.9e-6), {.coupled_groups = {"side"}}), "accepted");
  for (const double gap : {0.9e-6, 1.1e-6}) {
    Mesh mesh = triangles_apart(gap);
    mesh.positions.insert(mesh.positions.end(), {{0, 1, 1}, {0, 1, 1 + 1e-5}, {0, 2, 1}});
    mesh.node_numbers.insert(mesh.node_numbers.end(), {17, 18, 19});
    ElementBlock& block = mesh.blocks[0];
    block.numbers.push_back(3);
    block.group.push_back(-1);
    block.nodes.insert(block.nodes.end(), {6, 7, 8});
    EXPECT_EQ(refusal_of(mesh) == "accepted", gap > 1e-6);
    const MeshOptions wide{.coincident_nodes = Coincident::merge, .merge_tolerance = 1e-3};
    EXPECT_NE(refusal_of(mesh, wide).find("element 3 has two nodes within the tolerance of 0.001"),
              std::string::npos);
  }
}

TEST(CoincidentNodes, AreMergedIntoTheFirstOfThem)
{
  const Mesh mesh = treat_coincident_nodes(
      triangles_apart(1e-4), {.coincident_nodes = Coincident::merge, .merge_tolerance = 2e-4});
  EXPECT_EQ(mesh.node_numbers, (std::vector<std::int64_t>{11, 12, 13, 16}));
  EXPECT_EQ(mesh.blocks[0].nodes, (std::vector<int>{0, 1, 2, 1, 2, 3}));
  EXPECT_EQ(mesh.groups[0].nodes, (std::vector<int>{1, 2}));
  EXPECT_EQ(mesh.notes,
            (std::vector<std::string>{"2 coincident nodes were merged (within 0.0002 m)"}));
  Mesh row;  // each within reach of the next alone, the last not of them
  row.positions = {{2.4, 0, 0}, {1.6, 0, 0}, {0.8, 0, 0}, {0, 0, 0}, {-1.1, 0, 0}};
  EXPECT_EQ(coincident_nodes(row, 1.0), (std::vector<std::array<int, 2>>{{0, 1}, {0, 2}, {0, 3}}));
}

TEST(CoincidentNodes, AreNamedUpToTen)
{
  for (const int n : {10, 11}) {
    Mesh mesh;
    for (int i = 0; i < 2 * n; ++i) {
      mesh.positions.push_back({double(i / 2), 0, 0});
      mesh.node_numbers.push_back(i + 1);
    }
    EXPECT_EQ(refusal_of(mesh).find("19 and 20 ... (11 pairs)") != std::string::npos, n == 11);
    EXPECT_NE(refusal_of(mesh).find("19 and 20"), std::string::npos);
  }
}

/// A shape of which the edges of an element tell all.
Vector serendipity(double r, double s, int order)
{
  const double q = std::pow(r, order), t = std::pow(s, order);
  return {0.5 + r + 0.3 * q * s - 0.2 * t, s - 0.1 * q + 0.2 * r * t - 0.7,
          0.7 * r * s + q - 0.4 * t * r + 0.3};
}

TEST(InnerNodes, FollowFromTheEdgesOfAQuadrilateral)
{
  for (const int p : {2, 3}) {
    Mesh mesh;
    ElementBlock block{.shape = Shape::quadrilateral,
                       .order = p,
                       .nodes_per_element = (p + 1) * (p + 1),
                       .numbers = {1},
                       .nodes = {},
                       .group = {0}};
    std::vector<Vector> inner;
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i) {
        const Vector x = serendipity(double(i) / p, double(j) / p, p);
        const bool is_inner = i > 0 && j > 0 && i < p && j < p;
        block.nodes.push_back(is_inner ? -1 : mesh.n_nodes());
        (is_inner ? inner : mesh.positions).push_back(x);
        if (!is_inner) mesh.node_numbers.push_back(100 - mesh.n_nodes());
      }
    mesh.blocks = {block};
    mesh.groups = {{.name = "disc", .dimension = 2, .nodes = {}}};
    const int n = mesh.n_nodes();
    add_inner_nodes(mesh);
    ASSERT_EQ(mesh.positions.size(), std::size_t(n) + inner.size());
    for (std::size_t k = 0; k < inner.size(); ++k) {
      const auto node = std::size_t(n) + k;
      EXPECT_LT(norm(minus(mesh.positions[node], inner[k])), 4e-15);
      EXPECT_EQ(mesh.node_numbers[node], 100 + std::int64_t(k)) << "beyond the first one, 99";
      EXPECT_EQ(mesh.groups[0].nodes[k], int(node));
    }
    EXPECT_EQ(mesh.notes.at(0), "serendipity elements were completed by " +
                                    std::to_string(inner.size()) +
                                    " inner nodes, numbered from 100");
  }
}

TEST(InnerNodes, KeepQuadraticShapesOfACubicTriangleAndAreNoneOfOrder4)
{
  const auto shape = [](double r, double s) {
    return Vector{r + s * s, s - 0.3 * r * s, 0.2 + r * r - 0.4 * r * s};
  };
  for (const int p : {3, 4}) {
    Mesh mesh;
    ElementBlock block{.shape = Shape::triangle,
                       .order = p,
                       .nodes_per_element = (p + 1) * (p + 2) / 2,
                       .numbers = {8},
                       .nodes = {},
                       .group = {-1}};
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p - j; ++i) {
        const bool is_inner = i > 0 && j > 0 && i + j < p;
        block.nodes.push_back(is_inner ? -1 : mesh.n_nodes());
        if (is_inner) continue;
        mesh.positions.push_back(shape(double(i) / p, double(j) / p));
        mesh.node_numbers.push_back(mesh.n_nodes());
      }
    mesh.blocks = {block};
    if (p == 4) {
      EXPECT_THROW(add_inner_nodes(mesh), Error);
      continue;
    }
    add_inner_nodes(mesh);
    EXPECT_LT(norm(minus(mesh.positions.back(), shape(1.0 / 3.0, 1.0 / 3.0))), 1e-15);
  }
}

}  // namespace
}  // namespace chladni::mesh
