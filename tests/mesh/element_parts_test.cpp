#include "mesh/element_types.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <span>
#include <utility>

#include "generated.hpp"
#include "mesh/generators.hpp"
#include "mesh/sectors.hpp"

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

/// The volume within faces of which the corners go around counter-clockwise from outside.
double volume_within(const Mesh& mesh, std::span<const int> nodes, std::size_t n_corners)
{
  double six = 0.0;
  for (std::size_t k = 1; k + 1 < n_corners; ++k) {
    const auto x = [&](std::size_t i) { return mesh.positions[std::size_t(nodes[i])]; };
    six += dot(x(0), cross(x(k), x(k + 1)));
  }
  return six / 6.0;
}

/// The place of parent coordinates between straight edges.
Vector between_corners(const Mesh& mesh, const ElementBlock& block, int e,
                       const std::array<double, 3>& r)
{
  const auto places = solid_nodes(block.shape, 1);
  Vector x{};
  for (std::size_t c = 0; c < places.size(); ++c) {
    double N = 0.5 * (1.0 + r[2] * places[c][2]);
    if (block.shape == Shape::hexahedron) {
      N *= 0.25 * (1.0 + r[0] * places[c][0]) * (1.0 + r[1] * places[c][1]);
    } else {
      const std::array L{1.0 - r[0] - r[1], r[0], r[1]};
      N *= L[c % 3];
    }
    for (std::size_t d = 0; d < 3; ++d)
      x[d] += N * mesh.positions[std::size_t(block.element_nodes(e)[c])][d];
  }
  return x;
}

TEST(Extruded, FillsTheSpaceBetweenItsFacesWithSolids)
{
  for (const auto& [shape, order] : {std::pair{Shape::hexahedron, 1},
                                     {Shape::hexahedron, 2},
                                     {Shape::hexahedron, 3},
                                     {Shape::wedge, 1},
                                     {Shape::wedge, 2}}) {
    for (const int layers : {1, 3}) {
      const Mesh mesh = testing::block_about_z(order, shape, layers, layers == 1 ? 1.0 : -1.0);
      const ElementBlock& block = mesh.blocks.at(0);
      const int n_flat = shape == Shape::wedge ? 32 : 16;
      ASSERT_EQ(block.n_elements(), n_flat * layers);
      const double each = 0.8 / block.n_elements();
      const auto parent = solid_nodes(shape, order);
      for (int e = 0; e < block.n_elements(); ++e) {
        double volume = 0.0;
        for (const std::vector<int>& face : solid_faces(shape, order)) {
          std::vector<int> nodes;
          for (const int place : face) nodes.push_back(block.element_nodes(e)[std::size_t(place)]);
          volume += volume_within(mesh, nodes, face.size() == std::size_t(3 * order) ? 3 : 4);
        }
        EXPECT_NEAR(volume, each, 1e-15);
        for (std::size_t k = 0; k < parent.size(); ++k) {
          const Vector x = mesh.positions[std::size_t(block.element_nodes(e)[k])];
          EXPECT_LT(norm(minus(x, between_corners(mesh, block, e, parent[k]))), 1e-15);
        }
      }
      double volume = 0.0;
      const std::vector<FreeFace> skin = free_faces(mesh);
      for (const FreeFace& face : skin)
        volume += volume_within(mesh, face.nodes, std::ssize(face.nodes) == 3 * order ? 3 : 4);
      EXPECT_NEAR(volume, 0.8, 1e-14);
      EXPECT_EQ(std::ssize(skin), 2 * n_flat + 16 * layers);
      for (const auto& [name, z] : {std::pair{"bottom_face", -0.1}, {"top_face", 0.1}}) {
        const Group& face = find_group(mesh, name);
        EXPECT_EQ(face.dimension, 2);
        int n_there = 0;
        for (const Vector& x : mesh.positions) n_there += x[2] == z ? 1 : 0;
        EXPECT_EQ(std::ssize(face.nodes), n_there);
        for (const int node : face.nodes) EXPECT_EQ(mesh.positions[std::size_t(node)][2], z);
      }
      EXPECT_EQ(find_group(mesh, "plate").dimension, 3);
      EXPECT_EQ(std::ssize(find_group(mesh, "plate").nodes), mesh.n_nodes());
      EXPECT_EQ(find_group(mesh, "left").dimension, 2);
    }
  }
}

TEST(Extruded, OfOneSectorIsThisSectorOfTheSolid)
{
  const Mesh flat = annulus({.inner_radius = 0.05,
                             .outer_radius = 0.15,
                             .element_size = 0.05,
                             .element_order = 2,
                             .pattern = Pattern::structured,
                             .sectors = 6});
  const Mesh mesh = extruded(flat, {.from = 0.0, .to = 0.02, .layers = 2}, {});
  EXPECT_EQ(mesh.sectors.count, 6);
  // Corners have nodes in five planes, those between them on both faces of each layer alone.
  EXPECT_GT(mesh.sectors.pairs.size(), 3 * flat.sectors.pairs.size());
  EXPECT_LT(mesh.sectors.pairs.size(), 5 * flat.sectors.pairs.size());
  for (const auto& [low, high] : mesh.sectors.pairs) {
    const Vector x = turned(mesh.sectors, mesh.positions[std::size_t(low)]);
    EXPECT_LT(norm(minus(x, mesh.positions[std::size_t(high)])), 1e-15);
  }
}

}  // namespace
}  // namespace chladni::mesh
