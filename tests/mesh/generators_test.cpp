#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "generated.hpp"

namespace chladni::mesh {
namespace {

using testing::annulus_options;
using testing::area;
using testing::area_of_chords;
using testing::boundary_length;
using testing::directed_edges;
using testing::expect_radius;
using testing::expect_ring;
using testing::Generated;
using testing::hat_options;
using testing::pi;
using testing::radius;

TEST_P(Generated, AnnulusCoversItsAreaWithRingsAndEdgesOnTheirCircles)
{
  const AnnulusOptions options = annulus_options(pattern(), order());
  const Mesh mesh = annulus(options);
  expect_shapes(mesh);
  expect_ring(mesh, options.rings[0]);
  expect_radius(mesh, "inner_edge", 0.05);
  expect_radius(mesh, "outer_edge", 0.16);
  const double exact = pi * (0.16 * 0.16 - 0.05 * 0.05);
  EXPECT_NEAR(area(mesh, "disc"), exact, area_of_chords * exact);
  EXPECT_NEAR(boundary_length(mesh), 2.0 * pi * (0.16 + 0.05), area_of_chords);
}

TEST_P(Generated, HatDiscHasItsThreeSurfacesAndItsCircles)
{
  const HatDiscOptions options = hat_options(pattern(), order());
  const Mesh mesh = hat_disc(options);
  expect_shapes(mesh);
  for (const RingOptions& ring : options.rings) expect_ring(mesh, ring);
  for (const auto& [name, r] : {std::pair{"inner_edge", 0.07},
                                {"outer_edge", 0.16},
                                {"wall_seat", 0.08},
                                {"wall_foot", 0.08},
                                {"hub_edge", 0.03}})
    expect_radius(mesh, name, r);
  EXPECT_EQ(find_group(mesh, "wall_foot").nodes.size(), find_group(mesh, "wall_seat").nodes.size());
  const double disc = pi * (0.16 * 0.16 - 0.07 * 0.07);
  EXPECT_NEAR(area(mesh, "disc"), disc, area_of_chords * disc);
  const double flange = pi * (0.07 * 0.07 - 0.03 * 0.03);
  EXPECT_NEAR(area(mesh, "flange"), flange, 4.0 * area_of_chords * flange);  // small radii
  const double cone = pi * (0.08 + 0.07) * std::hypot(0.01, 0.04);
  EXPECT_NEAR(area(mesh, "wall"), cone, area_of_chords * cone);
  // The wall is joined to the flange, and free of the disc: a gap of 10 mm for a rigid link.
  EXPECT_NEAR(boundary_length(mesh), 2.0 * pi * (0.07 + 0.16 + 0.08 + 0.03), 0.03);
}

TEST_P(Generated, HatDiscHasAllNodesOfTheWallOnItsCone)
{
  const Mesh mesh = hat_disc(hat_options(pattern(), order()));
  for (const int node : find_group(mesh, "wall").nodes) {
    const double z = mesh.positions[node][2];
    EXPECT_NEAR(radius(mesh, node), 0.08 - 0.01 * (z - 0.01) / 0.04, 1e-9);
  }
}

TEST_P(Generated, HatDiscJoinedToItsWallHasThreeElementsOnTheSeat)
{
  HatDiscOptions options = hat_options(pattern(), order());
  options.foot = 0.0;
  const Mesh mesh = hat_disc(options);
  const Group& seat = find_group(mesh, "wall_seat");
  std::map<std::pair<int, int>, int> elements;
  for (const auto& [edge, count] : directed_edges(mesh)) {
    const auto [a, b] = std::minmax(edge.first, edge.second);
    elements[{a, b}] += count;
  }
  std::size_t n_on_seat = 0;
  for (const auto& [edge, count] : elements) {
    const bool on_seat = std::ranges::binary_search(seat.nodes, edge.first) &&
                         std::ranges::binary_search(seat.nodes, edge.second);
    n_on_seat += on_seat;
    EXPECT_EQ(count, on_seat ? 3 : std::min(count, 2));
  }
  EXPECT_EQ(n_on_seat * order(), seat.nodes.size());
}

TEST_P(Generated, PadIsASectorWithItsEdgesAndCorners)
{
  const PadOptions options{.inner_radius = 0.10,
                           .outer_radius = 0.15,
                           .angle = 1.0,
                           .centre_angle = pi / 2.0,
                           .element_size = 0.015,
                           .element_order = order(),
                           .pattern = pattern()};
  const Mesh mesh = pad(options);
  expect_shapes(mesh);
  expect_radius(mesh, "inner_edge", 0.10);
  expect_radius(mesh, "outer_edge", 0.15);
  for (const auto& [name, angle] :
       {std::pair{"first_edge", pi / 2.0 - 0.5}, {"last_edge", pi / 2.0 + 0.5}})
    for (const int node : find_group(mesh, name).nodes)
      EXPECT_NEAR(std::atan2(mesh.positions[node][1], mesh.positions[node][0]), angle, 1e-12);
  EXPECT_EQ(find_group(mesh, "corners").nodes.size(), 4u);
  const double exact = 0.5 * (0.15 * 0.15 - 0.10 * 0.10);
  EXPECT_NEAR(area(mesh, "pad"), exact, area_of_chords * exact);
  EXPECT_NEAR(boundary_length(mesh), 0.25 + 2 * 0.05, 1e-3);
}

TEST_P(Generated, RectangleFillsItsSides)
{
  const Mesh mesh = rectangle({.length = 0.3,
                               .width = 0.2,
                               .element_size = 0.05,
                               .element_order = order(),
                               .pattern = pattern()});
  expect_shapes(mesh);
  EXPECT_NEAR(area(mesh, "plate"), 0.06, 1e-12);  // straight edges: round-off
  EXPECT_NEAR(boundary_length(mesh), 1.0, 1e-12);
  for (const int node : find_group(mesh, "right").nodes)
    EXPECT_NEAR(mesh.positions[node][0], 0.3, 1e-15);
  for (const int node : find_group(mesh, "bottom").nodes) EXPECT_EQ(mesh.positions[node][1], 0.0);
  EXPECT_EQ(find_group(mesh, "corners").nodes.size(), 4u);
  EXPECT_EQ(find_group(mesh, "top").nodes.size(), 6u * order() + 1u);
}

INSTANTIATE_TEST_SUITE_P(Patterns, Generated,
                         ::testing::Combine(testing::all_patterns, ::testing::Values(1, 2, 3, 4)));

TEST(HatDisc, HasBoltHolesInItsFlange)
{
  HatDiscOptions options = hat_options(Pattern::unstructured, 3);
  options.bolts = {.count = 5, .circle_radius = 0.053, .hole_radius = 0.006};
  const Mesh mesh = hat_disc(options);
  const Group& second = find_group(mesh, "bolt_2");
  for (const int node : second.nodes) {
    const auto& x = mesh.positions[node];
    EXPECT_NEAR(std::hypot(x[0] - 0.053 * std::cos(0.4 * pi), x[1] - 0.053 * std::sin(0.4 * pi)),
                0.006, 1e-12);
    EXPECT_EQ(x[2], 0.05);
  }
  EXPECT_EQ(find_group(mesh, "bolt_edges").nodes.size(), 5 * second.nodes.size());
  const double flange = pi * (0.07 * 0.07 - 0.03 * 0.03 - 5 * 0.006 * 0.006);
  EXPECT_NEAR(area(mesh, "flange"), flange, 4.0 * area_of_chords * flange);
}

}  // namespace
}  // namespace chladni::mesh
