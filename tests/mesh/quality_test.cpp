#include "mesh/quality.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace chladni::mesh
