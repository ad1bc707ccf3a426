#include "plate/refinement/refined_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/generators.hpp"

namespace chladni::plate {
namespace {

mesh::Mesh disc(mesh::Pattern pattern, int order)
{
  return mesh::annulus({.inner_radius = 0.1,
                        .outer_radius = 0.2,
                        .element_size = 0.05,
                        .element_order = order,
                        .rings = {{.name = "track", .radius = 0.15, .nodes = 12}},
                        .pattern = pattern});
}

/// The largest distance of a group's nodes from a circle about the axis, m.
double off_circle(const mesh::Mesh& mesh, const std::string& group, double radius)
{
  double largest = 0.0;
  for (const int node : mesh::find_group(mesh, group).nodes) {
    const auto& x = mesh.positions[static_cast<std::size_t>(node)];
    largest = std::max(largest, std::abs(std::hypot(x[0], x[1]) - radius));
  }
  return largest;
}

/// Of all nodes: 1, x, y and their products up to third order, as displacements.
Eigen::MatrixXd cubics(const mesh::Mesh& mesh)
{
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(6 * mesh.n_nodes(), 10);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const auto& x = mesh.positions[static_cast<std::size_t>(node)];
    int column = 0;
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; i + j <= 3; ++j)
        motions(6 * node + 2, column++) = std::pow(x[0], i) * std::pow(x[1], j);
  }
  return motions;
}

TEST(RefinedMesh, KeepsCirclesAndGroups)
{
  for (const auto pattern : {mesh::Pattern::structured, mesh::Pattern::triangles}) {
    const mesh::Mesh coarse = disc(pattern, 3);
    const RefinedMesh fine = refined(coarse, {.parts = 2, .order = 3});
    EXPECT_LT(off_circle(fine.mesh, "outer_edge", 0.2), 1e-12);
    EXPECT_LT(off_circle(fine.mesh, "inner_edge", 0.1), 1e-12);
    EXPECT_EQ(mesh::find_group(fine.mesh, "outer_edge").nodes.size(),
              2 * mesh::find_group(coarse, "outer_edge").nodes.size());
    EXPECT_EQ(mesh::find_group(fine.mesh, "track").nodes.size(), 12U);
    EXPECT_EQ(mesh::find_group(fine.mesh, "disc").nodes.size(), fine.mesh.positions.size());
    EXPECT_TRUE(keeps_points(coarse, fine.mesh));
    EXPECT_EQ(fine.mesh.blocks.front().n_elements(), 4 * coarse.blocks.front().n_elements());
  }
}

/// On straight elements interpolation of order 3 loses nothing of cubics.
TEST(RefinedMesh, InterpolatesWhatItsElementsHold)
{
  for (const auto pattern : {mesh::Pattern::structured, mesh::Pattern::triangles}) {
    const mesh::Mesh coarse = mesh::rectangle(
        {.length = 1.0, .width = 1.0, .element_size = 0.4, .element_order = 3, .pattern = pattern});
    const std::vector<double> rows(coarse.positions.size(), 0.02);
    for (const Refinement& how :
         {Refinement{.parts = 1, .order = 2}, Refinement{.parts = 2, .order = 3},
          Refinement{.parts = 2, .order = 3, .edge_rows = rows}}) {
      const RefinedMesh fine = refined(coarse, how);
      const Eigen::MatrixXd found = interpolated(coarse, fine, cubics(coarse));
      EXPECT_LT((found - cubics(fine.mesh)).cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

/// Elements along the edges are cut at the width of the row, so that nodes stand there.
TEST(RefinedMesh, CutsElementsAtFreeEdges)
{
  constexpr double row = 0.02;
  for (const auto pattern : {mesh::Pattern::structured, mesh::Pattern::triangles}) {
    const mesh::Mesh coarse = mesh::rectangle({.length = 1.0,
                                               .width = 1.0,
                                               .element_size = 0.25,
                                               .element_order = 1,
                                               .pattern = pattern});
    const std::vector<double> rows(coarse.positions.size(), row);
    EXPECT_TRUE(has_wide_edges(coarse, rows));
    const RefinedMesh fine = refined(coarse, {.parts = 2, .order = 1, .edge_rows = rows});
    double nearest = 1.0;
    for (const auto& x : fine.mesh.positions)
      if (x[1] > 1e-12) nearest = std::min(nearest, x[1]);
    EXPECT_LE(nearest, row * (1.0 + 1e-12));
    EXPECT_GT(nearest, 0.5 * row);
    const std::vector<double> wide(coarse.positions.size(), 0.2);
    EXPECT_FALSE(has_wide_edges(coarse, wide));
  }
}

TEST(RefinedMesh, KeepsLinesOnTheCircleOfTheirNodes)
{
  mesh::ElementBlock block{.shape = mesh::Shape::line,
                           .order = 2,
                           .nodes_per_element = 3,
                           .numbers = {1, 2, 3, 4},
                           .nodes = {0, 1, 2, 2, 3, 4, 4, 5, 6, 6, 7, 0},
                           .group = {0, 0, 0, 0}};
  mesh::Mesh ring{.node_numbers = {1, 2, 3, 4, 5, 6, 7, 8},
                  .positions = {},
                  .blocks = {block},
                  .groups = {{.name = "rim", .dimension = 1, .nodes = {0, 1, 2, 3, 4, 5, 6, 7}}},
                  .notes = {}};
  for (int i = 0; i < 8; ++i) {
    ring.positions.push_back({0.2 * std::cos(0.25 * std::numbers::pi * i),
                              0.2 * std::sin(0.25 * std::numbers::pi * i), 0.0});
  }
  for (const Refinement& how : {Refinement{.parts = 2, .order = 2}, Refinement{.order = 4}}) {
    const RefinedMesh fine = refined(ring, how);
    EXPECT_EQ(fine.mesh.n_nodes(), 16);
    EXPECT_LT(off_circle(fine.mesh, "rim", 0.2), 1e-12);
  }
  EXPECT_TRUE(can_rise(ring));
}

TEST(RefinedMesh, KnowsWhichElementsHaveANextOrder)
{
  EXPECT_TRUE(can_rise(disc(mesh::Pattern::structured, 3)));
  EXPECT_FALSE(can_rise(disc(mesh::Pattern::structured, 4)));
  EXPECT_FALSE(can_rise(disc(mesh::Pattern::triangles, 3)));
  const RefinedMesh higher = refined(disc(mesh::Pattern::structured, 3), {.parts = 1, .order = 4});
  EXPECT_LT(off_circle(higher.mesh, "outer_edge", 0.2), 1e-12);
}

}  // namespace
}  // namespace chladni::plate
