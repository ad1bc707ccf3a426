#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

#include "common/error.hpp"
#include "mesh/generate.hpp"
#include "mesh/rings.hpp"
#include "surface.hpp"

namespace chladni::mesh {
namespace {

constexpr double pi = std::numbers::pi;
// Chords of elements of size h leave out (h / r)^2 / 6 of a circle's sector; h / r < 0.25 outside.
constexpr double area_of_chords = 1.2e-2;

AnnulusOptions annulus_options(Pattern pattern, int order)
{
  return {.inner_radius = 0.05,
          .outer_radius = 0.16,
          .element_size = 0.025,
          .element_order = order,
          .rings = {{.name = "track", .radius = 0.13, .nodes = 30}},
          .pattern = pattern,
          .edge_row = 0.008};
}

HatDiscOptions hat_options(Pattern pattern, int order)
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

double radius(const Mesh& mesh, int node)
{
  return std::hypot(mesh.positions[node][0], mesh.positions[node][1]);
}

void expect_ring(const Mesh& mesh, const RingOptions& ring)
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

void expect_radius(const Mesh& mesh, const std::string& group, double expected)
{
  for (const int node : find_group(mesh, group).nodes) {
    EXPECT_NEAR(radius(mesh, node), expected, 1e-12) << group;  // round-off of Gmsh's arcs
  }
}

/// Directed edges between corners, of all elements.
std::map<std::pair<int, int>, int> directed_edges(const Mesh& mesh)
{
  std::map<std::pair<int, int>, int> edges;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      const std::vector<int> corners = testing::corners(block, e);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        ++edges[{corners[i], corners[(i + 1) % corners.size()]}];
      }
    }
  }
  return edges;
}

/// Length of the edges that one element alone has; fails where neighbours turn differently.
double boundary_length(const Mesh& mesh)
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

double area(const Mesh& mesh, const std::string& group)
{
  double sum = 0.0;
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      if (mesh.groups[block.group[e]].name == group) sum += testing::corner_area_3d(mesh, block, e);
    }
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

TEST_P(Generated, AnnulusHasOneRowOfElementsAlongItsEdges)
{
  const AnnulusOptions options = annulus_options(pattern(), order());
  const Mesh mesh = annulus(options);
  for (const ElementBlock& block : mesh.blocks) {
    for (int e = 0; e < block.n_elements(); ++e) {
      for (const int node : testing::corners(block, e)) {
        const double r = radius(mesh, node);
        const bool inside_a_row = (r > 0.05 + 1e-9 && r < 0.058 - 1e-9) ||
                                  (r > 0.152 + 1e-9 && r < 0.16 - 1e-9);
        EXPECT_FALSE(inside_a_row) << r;
      }
    }
  }
}

TEST_P(Generated, HatDiscHasItsThreeSurfacesAndItsCircles)
{
  const HatDiscOptions options = hat_options(pattern(), order());
  const Mesh mesh = hat_disc(options);
  expect_shapes(mesh);
  for (const RingOptions& ring : options.rings) expect_ring(mesh, ring);
  for (const auto& [name, r] :
       {std::pair{"inner_edge", 0.07}, {"outer_edge", 0.16}, {"wall_seat", 0.08},
        {"wall_foot", 0.08}, {"hub_edge", 0.03}}) {
    expect_radius(mesh, name, r);
  }
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
  for (const auto& [name, angle] : {std::pair{"first_edge", pi / 2.0 - 0.5},
                                    {"last_edge", pi / 2.0 + 0.5}}) {
    for (const int node : find_group(mesh, name).nodes) {
      EXPECT_NEAR(std::atan2(mesh.positions[node][1], mesh.positions[node][0]), angle, 1e-12);
    }
  }
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
  for (const int node : find_group(mesh, "right").nodes) {
    EXPECT_NEAR(mesh.positions[node][0], 0.3, 1e-15);
  }
  for (const int node : find_group(mesh, "bottom").nodes) EXPECT_EQ(mesh.positions[node][1], 0.0);
  EXPECT_EQ(find_group(mesh, "corners").nodes.size(), 4u);
  EXPECT_EQ(find_group(mesh, "top").nodes.size(), 6u * order() + 1u);
}

INSTANTIATE_TEST_SUITE_P(Patterns, Generated,
                         ::testing::Combine(::testing::Values(Pattern::structured,
                                                              Pattern::unstructured,
                                                              Pattern::triangles),
                                            ::testing::Values(1, 2, 3, 4)));

TEST(Rectangle, HasOneRowOfElementsAlongAllFourEdges)
{
  const Mesh mesh = rectangle({.length = 0.3,
                               .width = 0.2,
                               .element_size = 0.05,
                               .element_order = 2,
                               .edge_row = 0.01});
  std::set<double> x, y;
  for (int e = 0; e < mesh.blocks[0].n_elements(); ++e) {
    for (const int node : testing::corners(mesh.blocks[0], e)) {
      x.insert(mesh.positions[node][0]);
      y.insert(mesh.positions[node][1]);
    }
  }
  EXPECT_NEAR(*std::next(x.begin()), 0.01, 1e-15);
  EXPECT_NEAR(*std::next(x.rbegin()), 0.29, 1e-15);
  EXPECT_NEAR(*std::next(y.begin()), 0.01, 1e-15);
  EXPECT_NEAR(*std::next(y.rbegin()), 0.19, 1e-15);
}

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

std::string error_of(const auto& generate)
{
  try {
    generate();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// The message of a hat disc with one change.
std::string hat_error(const std::function<void(HatDiscOptions&)>& change)
{
  HatDiscOptions options = hat_options(Pattern::structured, 2);
  change(options);
  return error_of([&] { hat_disc(options); });
}

TEST(HatDisc, NamesTheLengthsThatDoNotFit)
{
  EXPECT_EQ(hat_error([](auto& o) { o.hub_radius = 0.09; }),
            "hat_disc: hub_radius = 0.09 m must be less than top_radius = 0.07 m");
  EXPECT_EQ(hat_error([](auto& o) { o.foot = 0.06; }),
            "hat_disc: foot = 0.06 m must be less than height = 0.05 m");
  EXPECT_NE(hat_error([](auto& o) { o.rings[0].radius = 0.158; }).find("ring \"track\""),
            std::string::npos);
  EXPECT_NE(hat_error([](auto& o) { o.edge_row = 0.05; }).find("edge_row"), std::string::npos);
  EXPECT_NE(hat_error([](auto& o) { o.rings[1].nodes = 37; }).find("asks for 1332 structured"),
            std::string::npos);
  EXPECT_NE(hat_error([](auto& o) {
              o.bolts = {.count = 5, .circle_radius = 0.05, .hole_radius = 0.006};
            }).find("pattern"),
            std::string::npos);
}

TEST(Pad, NamesTheLengthsThatDoNotFit)
{
  const auto error = [](double outer_radius, double angle, double size) {
    return error_of([&] {
      pad({.inner_radius = 0.1, .outer_radius = outer_radius, .angle = angle, .element_size = size});
    });
  };
  EXPECT_NE(error(0.05, 1.0, 0.01).find("inner_radius < outer_radius"), std::string::npos);
  EXPECT_NE(error(0.15, 4.0, 0.01).find("angle"), std::string::npos);
  EXPECT_NE(error(0.15, 1.0, 0.1).find("element_size"), std::string::npos);
}

TEST(Rings, AskForZWhereTheHatStandsAboveTheirCircle)
{
  Mesh mesh = hat_disc(hat_options(Pattern::structured, 1));
  const auto ring = [&](std::optional<double> z) {
    return error_of([&] {
      Mesh copy = mesh;
      const RingOptions options{.name = "seat", .radius = 0.08, .nodes = 12, .z = z};
      add_rings(copy, std::span(&options, 1));
    });
  };
  EXPECT_NE(ring(std::nullopt).find("say which with z"), std::string::npos);
  EXPECT_EQ(ring(0.01), "no error");
}

}  // namespace
}  // namespace chladni::mesh
