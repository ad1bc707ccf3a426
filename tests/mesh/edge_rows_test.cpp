#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <vector>

#include "generated.hpp"
#include "mesh/curved_rows.hpp"
#include "mesh/quality.hpp"

namespace chladni::mesh {
namespace {

using testing::annulus_options;
using testing::area;
using testing::area_of_chords;
using testing::boundary_length;
using testing::Generated;
using testing::hat_options;
using testing::radius;

class EdgeRows : public Generated {};

TEST(BendTriangles, LaysTheirNodesEquallyBetweenTheirCornersInRadiusAndAngle)
{
  const CurvedRow row{.centre = {2.0, 3.0}, .inner = 0.9, .outer = 1.0};
  struct Place {
    double r, degrees, z;
  };
  const auto at = [&](const Place& p) {
    const double angle = p.degrees * std::numbers::pi / 180.0;
    return Vector{2.0 + p.r * std::cos(angle), 3.0 + p.r * std::sin(angle), p.z};
  };
  for (const int order : {1, 2, 3, 4}) {
    for (const double inner : {0.9, 0.92}) {  // the other one is not of the row
      const std::array<Place, 3> corners{
          {{1.0, 170.0, 0.0}, {1.0, 195.0, 0.1}, {inner, 185.0, 0.4}}};
      const Vector a = at(corners[0]), b = at(corners[1]), c = at(corners[2]);
      Mesh mesh;
      ElementBlock block{.shape = Shape::triangle,
                         .order = order,
                         .nodes_per_element = (order + 1) * (order + 2) / 2,
                         .numbers = {1},
                         .nodes = {},
                         .group = {-1}};
      std::vector<Vector> straight, bent;
      for (int j = 0; j <= order; ++j)
        for (int i = 0; i + j <= order; ++i) {
          const double r = double(i) / order, s = double(j) / order, t = 1.0 - r - s;
          straight.push_back({});
          for (std::size_t d = 0; d < 3; ++d) straight.back()[d] = t * a[d] + r * b[d] + s * c[d];
          bent.push_back(at({t * 1.0 + r * 1.0 + s * inner, t * 170.0 + r * 195.0 + s * 185.0,
                             r * 0.1 + s * 0.4}));
          block.nodes.push_back(int(bent.size()) - 1);
        }
      mesh.positions = straight;
      mesh.blocks = {block};
      bend_triangles(mesh, std::span(&row, 1));
      const std::vector<Vector>& expected = inner == 0.9 ? bent : straight;
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT(norm(minus(mesh.positions[i], expected[i])), 4e-15) << order << ", " << i;
    }
  }
}

TEST_P(EdgeRows, AnnulusHasOneRowOfElementsAlongItsEdges)
{
  const Mesh mesh = annulus(annulus_options(pattern(), order()));
  for (const auto& [edge, inside] : {std::pair{0.05, 0.058}, {0.16, 0.152}}) {
    const auto is_at = [&](double r) {
      return [&mesh, r](int node) { return std::abs(radius(mesh, node) - r) < 1e-9; };
    };
    std::set<int> on_edge;
    std::ptrdiff_t n_in_row = 0;
    for (const ElementBlock& block : mesh.blocks) {
      for (int e = 0; e < block.n_elements(); ++e) {
        const std::vector<int> corners = testing::corners(block, e);
        const auto n_on_edge = std::ranges::count_if(corners, is_at(edge));
        const auto n_inside = std::ranges::count_if(corners, is_at(inside));
        std::ranges::copy_if(corners, std::inserter(on_edge, on_edge.end()), is_at(edge));
        if (n_on_edge == 0) continue;
        ++n_in_row;
        EXPECT_EQ(n_on_edge + n_inside, std::ssize(corners));  // from one circle to the other
      }
    }
    const int n_columns = pattern() == Pattern::triangles ? 2 : 1;
    EXPECT_EQ(n_in_row, n_columns * std::ssize(on_edge));
  }
}

/// The arcs of an element of 30 mm bow by 0.7 mm.
TEST_P(EdgeRows, FoldNoElementWhereTheyAreThinnerThanTheirArcsBow)
{
  AnnulusOptions thin = annulus_options(pattern(), order());
  thin.element_size = 0.03;
  thin.edge_row = 0.0005;
  EXPECT_TRUE(unusable(quality(annulus(thin))).empty());
  HatDiscOptions hat = hat_options(pattern(), order());
  hat.element_size = 0.03;
  hat.edge_row = 0.0005;
  EXPECT_TRUE(unusable(quality(hat_disc(hat))).empty());
  EXPECT_TRUE(unusable(quality(pad({.inner_radius = 0.10,
                                    .outer_radius = 0.15,
                                    .angle = 1.0,
                                    .element_size = 0.03,
                                    .element_order = order(),
                                    .pattern = pattern(),
                                    .edge_row = 0.0005})))
                  .empty());
}

TEST_P(EdgeRows, StandAlongAllFourEdgesOfARectangle)
{
  const Mesh mesh = rectangle({.length = 0.3,
                               .width = 0.2,
                               .element_size = 0.05,
                               .element_order = order(),
                               .pattern = pattern(),
                               .edge_row = 0.01});
  expect_shapes(mesh);
  EXPECT_NEAR(area(mesh, "plate"), 0.06, 1e-12);  // straight edges: round-off
  EXPECT_NEAR(boundary_length(mesh), 1.0, 1e-12);
  EXPECT_EQ(find_group(mesh, "corners").nodes.size(), 4u);
  std::set<double> x, y;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const int node : testing::corners(block, e)) {
        x.insert(std::round(1e9 * mesh.positions[node][0]));
        y.insert(std::round(1e9 * mesh.positions[node][1]));
      }
    }
  }
  EXPECT_EQ(*std::next(x.begin()), 1e7);  // nm
  EXPECT_EQ(*std::next(x.rbegin()), 29e7);
  EXPECT_EQ(*std::next(y.begin()), 1e7);
  EXPECT_EQ(*std::next(y.rbegin()), 19e7);
}

TEST_P(EdgeRows, StandAlongTheArcsOfAPad)
{
  const Mesh mesh = pad({.inner_radius = 0.10,
                         .outer_radius = 0.15,
                         .angle = 1.0,
                         .element_size = 0.015,
                         .element_order = order(),
                         .pattern = pattern(),
                         .edge_row = 0.004});
  expect_shapes(mesh);
  EXPECT_EQ(find_group(mesh, "corners").nodes.size(), 4u);
  const double exact = 0.5 * (0.15 * 0.15 - 0.10 * 0.10);
  EXPECT_NEAR(area(mesh, "pad"), exact, area_of_chords * exact);
  EXPECT_NEAR(boundary_length(mesh), 0.25 + 2 * 0.05, 1e-3);
  std::set<double> radii;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e)
      for (const int node : testing::corners(block, e))
        radii.insert(std::round(1e9 * radius(mesh, node)));
  }
  EXPECT_EQ(*std::next(radii.begin()), 104e6);  // nm
  EXPECT_EQ(*std::next(radii.rbegin()), 146e6);
}

INSTANTIATE_TEST_SUITE_P(Patterns, EdgeRows,
                         ::testing::Combine(testing::all_patterns, ::testing::Values(1, 3)));

TEST(HatDisc, HasRowsOfElementsAroundItsBolts)
{
  HatDiscOptions options = testing::hat_options(Pattern::unstructured, 3);
  options.bolts = {.count = 5, .circle_radius = 0.053, .hole_radius = 0.006};
  const Mesh mesh = hat_disc(options);
  std::set<double> distances;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const int node : testing::corners(block, e)) {
        const auto& x = mesh.positions[node];
        if (x[2] != options.height) continue;
        distances.insert(std::round(1e9 * std::hypot(x[0] - 0.053, x[1])));
      }
    }
  }
  EXPECT_EQ(*distances.begin(), 6e6);  // nm
  EXPECT_EQ(*std::next(distances.begin()), 6e6 + 4e6);
}

}  // namespace
}  // namespace chladni::mesh
