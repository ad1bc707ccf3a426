#include "mesh/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

using Vector = std::array<double, 3>;

/// One element of this order whose nodes lie on the straight element of these corners.
Mesh element(const std::vector<Vector>& corners, int p)
{
  const bool triangle = corners.size() == 3;
  Mesh mesh;
  ElementBlock block{.shape = triangle ? Shape::triangle : Shape::quadrilateral,
                     .order = p,
                     .nodes_per_element = 0,
                     .numbers = {7},
                     .nodes = {},
                     .group = {-1}};
  for (int j = 0; j <= p; ++j) {
    for (int i = 0; i <= (triangle ? p - j : p); ++i) {
      const double r = double(i) / p, s = double(j) / p;
      const std::vector<double> N =
          triangle ? std::vector{1 - r - s, r, s}
                   : std::vector{(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s};
      Vector x{};
      for (std::size_t k = 0; k < N.size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) x[c] += N[k] * corners[k][c];
      block.nodes.push_back(mesh.n_nodes());
      mesh.positions.push_back(x);
      mesh.node_numbers.push_back(mesh.n_nodes());
    }
  }
  block.nodes_per_element = mesh.n_nodes();
  mesh.blocks.push_back(block);
  return mesh;
}

class QualityOfOrder : public ::testing::TestWithParam<int> {
 protected:
  static ElementQuality of(const std::vector<Vector>& corners)
  {
    return quality(element(corners, GetParam())).at(0);
  }
};

TEST_P(QualityOfOrder, IsBestForSquareAndEquilateralTriangle)
{
  for (const ElementQuality& q : {of({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}),
                                  of({{0, 0, 1}, {1, 0, 1}, {0.5, std::sqrt(0.75), 1}})}) {
    EXPECT_EQ(q.number, 7);
    EXPECT_NEAR(q.scaled_jacobian, 1.0, 1e-12);
    EXPECT_NEAR(q.aspect_ratio, 1.0, 1e-12);
    EXPECT_NEAR(q.warp, 0.0, 1e-12);
    EXPECT_NEAR(q.skew, 0.0, 1e-12);
  }
}

TEST_P(QualityOfOrder, IsTheSineOfARhombusAndTheRatioOfARectangle)
{
  const double c = std::cos(std::numbers::pi / 6.0);
  const ElementQuality rhombus = of({{0, 0, 0}, {1, 0, 0}, {1 + c, 0.5, 0}, {c, 0.5, 0}});
  EXPECT_NEAR(rhombus.scaled_jacobian, 0.5, 1e-12);
  EXPECT_NEAR(rhombus.skew, 2.0 / 3.0, 1e-12);  // 30 instead of 90 degrees
  EXPECT_NEAR(of({{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {0, 2, 0}}).aspect_ratio, 2.5, 1e-12);
}

TEST_P(QualityOfOrder, OfATriangleIsTheSameFromEachCorner)
{
  const std::vector<Vector> x{{0, 0, 0}, {3, 0, 0}, {1, 1, 0}};
  const double first = of(x).scaled_jacobian;
  EXPECT_NEAR(of({x[1], x[2], x[0]}).scaled_jacobian, first, 1e-12);
  EXPECT_NEAR(of({x[2], x[0], x[1]}).scaled_jacobian, first, 1e-12);
  // Twice the area over the product of the longest two edges.
  EXPECT_NEAR(first, 3.0 / (3.0 * std::sqrt(5.0)) * 2.0 / std::sqrt(3.0), 1e-12);
}

TEST_P(QualityOfOrder, SeesOneCornerOutOfThePlane)
{
  // The halves of the lifted corner fold by 90 degrees about their diagonal.
  const double up = std::sqrt(0.5);
  const ElementQuality q = of({{0, 0, 0}, {1, 0, 0}, {0.5, 0.5, up}, {0, 1, 0}});
  EXPECT_NEAR(q.warp, 90.0, 1e-9);
}

TEST_P(QualityOfOrder, IsNotPositiveWhereTheElementIsFoldedOrFlat)
{
  const ElementQuality folded = of({{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}});
  EXPECT_LT(folded.scaled_jacobian, 0.0);
  const ElementQuality flat = of({{0, 0, 0}, {1, 0, 0}, {0.5, 0.5, 0}, {0, 1, 0}});
  EXPECT_NEAR(flat.scaled_jacobian, 0.0, 1e-12);
  const ElementQuality collapsed = of({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const ElementQuality& q : {folded, flat, collapsed})
    EXPECT_EQ(unusable({q}), std::vector<std::int64_t>{7});
}

INSTANTIATE_TEST_SUITE_P(Orders, QualityOfOrder, ::testing::Values(1, 2, 3, 4));

TEST(Quality, SeesANodeOfAnEdgeThatIsMovedPastItsNeighbour)
{
  Mesh mesh = element({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 2);
  EXPECT_TRUE(unusable(quality(mesh)).empty());
  mesh.positions[1][0] = 0.9;  // the tangent turns over beyond three quarters of the edge
  EXPECT_EQ(unusable(quality(mesh)).size(), 1u);
}

TEST(Quality, OfAStructuredDiscIsThatOfItsRectangles)
{
  const Mesh disc = annulus({.inner_radius = 0.1,
                             .outer_radius = 0.2,
                             .element_size = 0.02,
                             .element_order = 3,
                             .rings = {},
                             .pattern = Pattern::structured});
  for (const ElementQuality& q : quality(disc)) {
    EXPECT_NEAR(q.scaled_jacobian, 1.0, 1e-3);  // nearly polar coordinates
    EXPECT_LT(q.aspect_ratio, 2.2);
    EXPECT_NEAR(q.warp, 0.0, 1e-9);
  }
}

TEST(CheckUsable, NamesTheFirstElementsAndTheirNumber)
{
  const Mesh folded = element({{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}, 2);
  Mesh mesh = folded;
  mesh.blocks[0].numbers.clear();
  mesh.blocks[0].nodes.clear();
  for (int e = 1; e <= 12; ++e) {
    mesh.blocks[0].numbers.push_back(100 + e);
    for (const int node : folded.blocks[0].nodes) mesh.blocks[0].nodes.push_back(node);
  }
  mesh.blocks[0].group.assign(12, -1);
  try {
    check_usable(mesh, "disc");
    FAIL() << "folded elements pass";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("disc: 12 elements are degenerate"), 0u) << text;
    EXPECT_NE(text.find("101, 102"), std::string::npos) << text;
    EXPECT_NE(text.find("110, ...;"), std::string::npos) << text;
  }
}

/// Elements of order 1 with these corners, all in one group.
Mesh of_corners(const std::vector<Vector>& nodes, const std::vector<std::vector<int>>& elements)
{
  Mesh mesh;
  mesh.positions = nodes;
  for (int i = 0; i < mesh.n_nodes(); ++i) mesh.node_numbers.push_back(i + 1);
  mesh.groups.push_back({.name = "plate", .dimension = 2, .nodes = {}});
  for (const std::size_t n : {3U, 4U}) {
    ElementBlock block{.shape = n == 3 ? Shape::triangle : Shape::quadrilateral,
                       .order = 1,
                       .nodes_per_element = int(n),
                       .numbers = {},
                       .nodes = {},
                       .group = {}};
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (elements[e].size() != n) continue;
      std::vector<int> lattice = elements[e];
      if (n == 4) std::swap(lattice[2], lattice[3]);
      block.nodes.insert(block.nodes.end(), lattice.begin(), lattice.end());
      block.numbers.push_back(std::int64_t(e) + 1);
      block.group.push_back(0);
    }
    if (!block.numbers.empty()) mesh.blocks.push_back(block);
  }
  return mesh;
}

std::vector<std::array<std::int64_t, 2>> pairs_of(const Mesh& mesh)
{
  std::vector<std::array<std::int64_t, 2>> pairs;
  for (const auto& [first, second] : overlaps(mesh)) pairs.push_back({first, second});
  return pairs;
}

/// Triangles around a node in a square of side 2, with `up` of all nodes as a function of x.
Mesh fan(
    const Vector& middle, double (*up)(double) = [](double) { return 0.0; })
{
  std::vector<Vector> nodes{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0},
                            {1, 2, 0}, {0, 2, 0}, {0, 1, 0}, middle};
  for (Vector& x : nodes) x[2] = up(x[0]);
  std::vector<std::vector<int>> elements;
  for (int i = 0; i < 8; ++i) elements.push_back({i, (i + 1) % 8, 8});
  return of_corners(nodes, elements);
}

using Pairs = std::vector<std::array<std::int64_t, 2>>;

TEST(Overlaps, AreNoneInASoundFan)
{
  EXPECT_EQ(pairs_of(fan({0.7, 1.2, 0})), Pairs());
  EXPECT_EQ(complaint_about(fan({0.7, 1.2, 0})), "");
}

TEST(Overlaps, AreFoundWhereANodeHasLeftItsFan)
{
  // Beyond the corner (2, 2) some triangles are turned over; each is a good one by itself.
  const Mesh mesh = fan({2.3, 2.1, 0});
  EXPECT_TRUE(unusable(quality(mesh)).empty());
  EXPECT_EQ(std::ranges::count(pairs_of(mesh), std::array<std::int64_t, 2>{2, 3}), 1);
  EXPECT_NE(complaint_about(mesh).find("2 and 3"), std::string::npos) << complaint_about(mesh);
}

/// Triangles on a cylinder of radius 1 m, 0.1 m wide, with one node moved.
Mesh on_cylinder(double around, double up)
{
  constexpr int n = 8;
  std::vector<Vector> nodes;
  std::vector<std::vector<int>> elements;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool is_moved = i == 4 && j == 4;
      const double angle = 0.1 * i + (is_moved ? around : 0.0);
      nodes.push_back({std::cos(angle), std::sin(angle), 0.1 * j + (is_moved ? up : 0.0)});
      const int a = j * (n + 1) + i;
      if (i == n || j == n) continue;
      elements.push_back({a, a + 1, a + n + 2});
      elements.push_back({a, a + n + 2, a + n + 1});
    }
  }
  return of_corners(nodes, elements);
}

TEST(Overlaps, AreFoundOnACurvedSurface)
{
  EXPECT_EQ(pairs_of(on_cylinder(0.0, 0.0)), Pairs());
  EXPECT_EQ(pairs_of(on_cylinder(0.03, -0.02)), Pairs());
  for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    const Mesh mesh = on_cylinder(0.15 * std::cos(angle), 0.15 * std::sin(angle));
    EXPECT_TRUE(unusable(quality(mesh)).empty());
    EXPECT_FALSE(pairs_of(mesh).empty()) << angle;
  }
}

TEST(Overlaps, AreFoundBetweenUnconnectedPartsOfAFlatGroup)
{
  const std::vector<Vector> nodes{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                  {1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}};
  Mesh mesh = of_corners(nodes, {{0, 1, 2, 3}, {4, 5, 6, 7}});
  EXPECT_EQ(pairs_of(mesh), (Pairs{{1, 2}}));
  mesh.groups.push_back({.name = "doubler", .dimension = 2, .nodes = {}});
  mesh.blocks[0].group[1] = 1;  // two plates that somebody means
  EXPECT_EQ(pairs_of(mesh), Pairs());
}

TEST(Overlaps, AreNoneAtJointsFoldsAndSharpEdges)
{
  for (const double angle : {90.0, 45.0, 15.0}) {  // of a third plate on two
    const double c = std::cos(angle * std::numbers::pi / 180.0), s = std::sqrt(1.0 - c * c);
    const std::vector<Vector> nodes{{0, 0, 0},  {0, 1, 0},  {1, 0, 0}, {1, 1, 0},
                                    {-1, 0, 0}, {-1, 1, 0}, {c, 0, s}, {c, 1, s}};
    EXPECT_EQ(pairs_of(of_corners(nodes, {{0, 2, 3, 1}, {0, 1, 5, 4}, {0, 6, 7, 1}})), Pairs());
    EXPECT_EQ(pairs_of(of_corners(nodes, {{0, 2, 3, 1}, {0, 6, 7, 1}})), Pairs());
  }
}

TEST(Overlaps, OfElementsWithTheSameNodesDoNotCount)
{
  const std::vector<Vector> nodes{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(pairs_of(of_corners(nodes, {{0, 1, 2, 3}, {1, 2, 3, 0}})), Pairs());
  EXPECT_EQ(pairs_of(of_corners(nodes, {{0, 1, 2, 3}, {0, 1, 2}})), (Pairs{{1, 2}}));
}

class MendedAnnulus : public ::testing::TestWithParam<std::tuple<double, int, int>> {};

TEST_P(MendedAnnulus, HasElementsSideBySide)
{
  const auto& [size, nodes, order] = GetParam();
  const Mesh mesh = annulus({.inner_radius = 0.047,
                             .outer_radius = 0.143,
                             .element_size = size,
                             .element_order = order,
                             .rings = {{.name = "track", .radius = 0.1175, .nodes = nodes}}});
  EXPECT_EQ(complaint_about(mesh), "");
}

// With 11 mm and 44 nodes Gmsh 4.8.4 turns a triangle over.
INSTANTIATE_TEST_SUITE_P(All, MendedAnnulus,
                         ::testing::Combine(::testing::Values(0.009, 0.011, 0.013),
                                            ::testing::Values(30, 44, 45),
                                            ::testing::Values(2, 3)));

}  // namespace
}  // namespace chladni::mesh
