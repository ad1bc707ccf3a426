#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "surface.hpp"

namespace chladni::mesh {
namespace {

AnnulusOptions coarse(int order)
{
  return {.inner_radius = 0.025,
          .outer_radius = 0.162,
          .element_size = 0.02,
          .element_order = order,
          .rings = {{.name = "track", .radius = 0.13, .nodes = 60}}};
}

class AnnulusOfOrder : public ::testing::TestWithParam<int> {};

TEST_P(AnnulusOfOrder, HasTheRingNodesExactlyOnTheCircleInOrderOfAngle)
{
  const Mesh mesh = annulus(coarse(GetParam()));
  const Group& track = find_group(mesh, "track");
  ASSERT_EQ(track.nodes.size(), 60u);
  for (int i = 0; i < 60; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 60;
    EXPECT_EQ(mesh.positions[track.nodes[i]][0], 0.13 * std::cos(angle));
    EXPECT_EQ(mesh.positions[track.nodes[i]][1], 0.13 * std::sin(angle));
  }
}

TEST_P(AnnulusOfOrder, CoversTheAreaWithElementsOfOneOrientation)
{
  const Mesh mesh = annulus(coarse(GetParam()));
  double area = 0.0;
  for (const ElementBlock& block : mesh.blocks) {
    EXPECT_EQ(block.order, GetParam());
    for (int e = 0; e < block.n_elements(); ++e) {
      const double a = testing::corner_area(mesh, block, e);
      EXPECT_GT(a, 0.0);
      area += a;
    }
  }
  const double exact = std::numbers::pi * (0.162 * 0.162 - 0.025 * 0.025);
  // Chords of elements of 20 mm leave out (h / r)^2 / 6 of a circle's sector.
  EXPECT_NEAR(area, exact, 5e-3 * exact);
}

TEST_P(AnnulusOfOrder, StoresLatticeNodesAtEqualDistancesAlongStraightEdges)
{
  const Mesh mesh = annulus(coarse(GetParam()));
  const int p = GetParam();
  int straight = 0;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const auto nodes = block.element_nodes(e);
      const auto& first = mesh.positions[nodes[0]];
      const auto& last = mesh.positions[nodes[p]];
      const auto& inner = mesh.positions[nodes[1]];
      const double x = first[0] + (last[0] - first[0]) / p;
      const double y = first[1] + (last[1] - first[1]) / p;
      straight += std::hypot(inner[0] - x, inner[1] - y) < 1e-12;
    }
  }
  EXPECT_GT(straight, 20);  // all but the edges on the three circles
}

TEST_P(AnnulusOfOrder, PutsAllNodesOfTheEdgesOnTheirCircles)
{
  const Mesh mesh = annulus(coarse(GetParam()));
  for (const auto& [name, radius] : {std::pair{"inner_edge", 0.025}, {"outer_edge", 0.162}}) {
    const Group& edge = find_group(mesh, name);
    EXPECT_GE(edge.nodes.size(), 8u);
    for (const int node : edge.nodes) {
      const auto& x = mesh.positions[node];
      EXPECT_NEAR(std::hypot(x[0], x[1]), radius, 1e-12);  // round-off of Gmsh's arc
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, AnnulusOfOrder, ::testing::Values(1, 2, 3));

TEST(Annulus, RefusesARingOutsideTheDisc)
{
  AnnulusOptions options = coarse(2);
  options.rings[0].radius = 0.2;
  EXPECT_THROW(annulus(options), Error);
}

TEST(FindGroup, NamesTheGroupsThatExist)
{
  const Mesh mesh = annulus(coarse(2));
  try {
    find_group(mesh, "hub");
    FAIL() << "an unknown group is found";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("inner_edge"), std::string::npos);
  }
}

TEST(Checksum, ChangesWithOneCoordinate)
{
  Mesh mesh = annulus(coarse(2));
  const std::string before = checksum(mesh);
  EXPECT_EQ(before, checksum(annulus(coarse(2))));
  mesh.positions[7][1] += 1e-15;
  EXPECT_NE(before, checksum(mesh));
}

}  // namespace
}  // namespace chladni::mesh
