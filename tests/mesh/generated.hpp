#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "mesh/extrude.hpp"
#include "mesh/generators.hpp"
#include "surface.hpp"
#include "tests/plate/square_plate.hpp"

/// Small generated meshes, and what there is to measure on them.
namespace chladni::mesh::testing {

inline constexpr double pi = std::numbers::pi;
// Chords of elements of size h leave out (h / r)^2 / 6 of a circle's sector; h / r < 0.25 outside.
inline constexpr double area_of_chords = 1.2e-2;

inline AnnulusOptions annulus_options(Pattern pattern, int order)
{
  return {.inner_radius = 0.05,
          .outer_radius = 0.16,
          .element_size = 0.025,
          .element_order = order,
          .rings = {{.name = "track", .radius = 0.13, .nodes = 30}},
          .pattern = pattern,
          .edge_row = 0.008};
}

inline HatDiscOptions hat_options(Pattern pattern, int order)
{
  return {.inner_radius = 0.07,
          .outer_radius = 0.16,
          .wall_radius = 0.08,
          .top_radius = 0.07,
          .hub_radius = 0.03,
          .height = 0.05,
          .foot = 0.01,
          .element_size = 0.02,
          .element_order = order,
          .rings = {{.name = "track", .radius = 0.13, .nodes = 36},
                    {.name = "inner_track", .radius = 0.11, .nodes = 12}},
          .pattern = pattern,
          .edge_row = 0.004};
}

inline double radius(const Mesh& mesh, int node)
{
  return std::hypot(mesh.positions[node][0], mesh.positions[node][1]);
}

inline void expect_ring(const Mesh& mesh, const RingOptions& ring)
{
  const Group& group = find_group(mesh, ring.name);
  ASSERT_EQ(std::ssize(group.nodes), ring.nodes);
  for (int i = 0; i < ring.nodes; ++i) {
    const auto& x = mesh.positions[group.nodes[i]];
    const double angle = 2.0 * pi * i / ring.nodes;
    EXPECT_EQ(x[0], ring.radius * std::cos(angle));
    EXPECT_EQ(x[1], ring.radius * std::sin(angle));
    EXPECT_EQ(x[2], 0.0);
  }
}

inline void expect_radius(const Mesh& mesh, const std::string& group, double expected)
{
  for (const int node : find_group(mesh, group).nodes)
    EXPECT_NEAR(radius(mesh, node), expected, 1e-12) << group;  // round-off of Gmsh's arcs
}

/// Directed edges between corners, of all elements.
inline std::map<std::pair<int, int>, int> directed_edges(const Mesh& mesh)
{
  std::map<std::pair<int, int>, int> edges;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::vector<int> corners = testing::corners(block, e);
      for (std::size_t i = 0; i < corners.size(); ++i)
        ++edges[{corners[i], corners[(i + 1) % corners.size()]}];
    }
  }
  return edges;
}

/// Length of the edges that one element alone has; fails where neighbours turn differently.
inline double boundary_length(const Mesh& mesh)
{
  double length = 0.0;
  const auto edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << "two elements run along an edge in the same direction";
    if (edges.contains({edge.second, edge.first})) continue;
    const auto& a = mesh.positions[edge.first];
    const auto& b = mesh.positions[edge.second];
    length += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  return length;
}

inline double area(const Mesh& mesh, const std::string& group)
{
  double sum = 0.0;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e)
      if (mesh.groups[block.group[e]].name == group) sum += corner_area_3d(mesh, block, e);
  }
  return sum;
}

class Generated : public ::testing::TestWithParam<std::tuple<Pattern, int>> {
 protected:
  Pattern pattern() const { return std::get<0>(GetParam()); }
  int order() const { return std::get<1>(GetParam()); }
  void expect_shapes(const Mesh& mesh) const
  {
    for (const ElementBlock& block : mesh.blocks) {
      EXPECT_EQ(block.order, order());
      const bool triangle = block.shape == Shape::triangle;
      EXPECT_FALSE(triangle && pattern() == Pattern::structured);
      EXPECT_FALSE(!triangle && pattern() == Pattern::triangles);
    }
  }
};

inline const auto all_patterns =
    ::testing::Values(Pattern::structured, Pattern::unstructured, Pattern::triangles);

/// A block [-1, 1] x [-1, 1] x [-0.1, 0.1] of four by four hexahedra, or of wedges.
/// @param side  -1: over surfaces that look down
inline Mesh block_about_z(int order, Shape shape, int layers = 1, double side = 1.0)
{
  Mesh flat = plate::testing::rectangle({.a = 2.0, .b = 2.0, .n_x = 4, .n_y = 4, .order = order});
  for (auto& x : flat.positions) x = {side * (x[0] - 1.0), x[1] - 1.0, x[2]};
  const ElementBlock quads = flat.blocks[0];
  if (shape == Shape::wedge) {
    ElementBlock halves{.shape = Shape::triangle,
                        .order = order,
                        .nodes_per_element = (order + 1) * (order + 2) / 2,
                        .numbers = {},
                        .nodes = {},
                        .group = {}};
    for (int e = 0; e < 2 * quads.n_elements(); ++e) {
      const auto nodes = quads.element_nodes(e / 2);
      for (int j = 0; j <= order; ++j)
        for (int i = 0; i <= order - j; ++i) {
          const int place = j * (order + 1) + i;
          halves.nodes.push_back(
              nodes[std::size_t(e % 2 == 0 ? place : (order + 1) * (order + 1) - 1 - place)]);
        }
      halves.numbers.push_back(e + 1);
      halves.group.push_back(quads.group[0]);
    }
    flat.blocks[0] = halves;
  }
  return extruded(flat, {.from = -0.1, .to = 0.1, .layers = layers}, {});
}

}  // namespace chladni::mesh::testing
