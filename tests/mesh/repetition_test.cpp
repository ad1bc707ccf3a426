#include "mesh/sectors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "common/error.hpp"
#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

AnnulusOptions repeated_disc(int sectors = 1)
{
  return {.inner_radius = 0.05,
          .outer_radius = 0.15,
          .element_size = 0.03,
          .element_order = 2,
          .rings = {{.name = "track", .radius = 0.1, .nodes = 16}},
          .pattern = Pattern::structured,
          .sectors = sectors};
}

TEST(Repetitions, OfAPlainDiscAreItsElementsAroundUnlessARingHasFewerNodes)
{
  AnnulusOptions plain = repeated_disc();
  plain.rings.clear();
  const Mesh mesh = annulus(plain);
  const int n_rows = mesh.blocks[0].n_elements() / n_repetitions(mesh);
  EXPECT_EQ(mesh.blocks[0].n_elements() % n_repetitions(mesh), 0);
  EXPECT_LE(n_rows, 5);
  EXPECT_EQ(n_repetitions(annulus(repeated_disc())), 16);
}

TEST(Repetitions, EndWhereANodeAnElementsGroupOrASetOfNodesDiffers)
{
  Mesh moved = annulus(repeated_disc());
  moved.positions[7][2] += 1e-4;
  EXPECT_EQ(n_repetitions(moved), 1);
  Mesh marked = annulus(repeated_disc());
  marked.groups.push_back({.name = "point", .dimension = 0, .nodes = {7}});
  EXPECT_EQ(n_repetitions(marked), 1);
  Mesh patched = annulus(repeated_disc());
  patched.groups.push_back({.name = "patch", .dimension = 2, .nodes = {}});
  patched.blocks[0].group[3] = static_cast<int>(patched.groups.size()) - 1;
  EXPECT_EQ(n_repetitions(patched), 1);
}

TEST(OneSector, OfAWholeDiscIsTheGeneratorsSector)
{
  const Mesh ours = one_sector(annulus(repeated_disc()), 16), theirs = annulus(repeated_disc(16));
  ASSERT_EQ(ours.n_nodes(), theirs.n_nodes());
  EXPECT_EQ(ours.sectors.count, 16);
  EXPECT_EQ(ours.sectors.pairs.size(), theirs.sectors.pairs.size());
  EXPECT_EQ(ours.blocks[0].n_elements(), theirs.blocks[0].n_elements());
  EXPECT_EQ(find_group(ours, "track").nodes.size(), find_group(theirs, "track").nodes.size());
  double top_ours = 0.0, top_theirs = 0.0;
  for (const auto& x : ours.positions) top_ours = std::max(top_ours, x[1]);
  for (const auto& x : theirs.positions) top_theirs = std::max(top_theirs, x[1]);
  EXPECT_NEAR(top_ours, top_theirs, 1e-12);
}

TEST(OneSector, MayBeNarrowBesideItsSides)
{
  AnnulusOptions wide = repeated_disc();
  wide.inner_radius = 0.025;
  wide.outer_radius = 0.162;
  wide.rings = {{.name = "track", .radius = 0.13, .nodes = 60}};
  wide.element_size = 0.05;
  const Mesh sector = one_sector(annulus(wide), 60);
  EXPECT_EQ(sector.blocks[0].n_elements(), 3) << "two within the ring, one without";
  EXPECT_EQ(sector.sectors.pairs.size(), 7u);
}

TEST(OneSector, OfAMeshThatDoesNotRepeatIsNone)
{
  Mesh moved = annulus(repeated_disc());
  moved.positions[7][2] += 1e-4;
  EXPECT_THROW(one_sector(moved, 16), Error);
  EXPECT_THROW(one_sector(annulus(repeated_disc()), 7), Error);
}

/// A disc whose sectors have vanes, radial plates on one side of it.
Mesh disc_with_vanes(double first_angle, int n_vanes)
{
  AnnulusOptions options = repeated_disc();
  options.rings[0].nodes = 4 * n_vanes;
  Mesh mesh = annulus(options);
  const double c = std::cos(first_angle), s = std::sin(first_angle);
  for (auto& x : mesh.positions) x = {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
  const auto group = static_cast<int>(mesh.groups.size());
  mesh.groups.push_back({.name = "vanes", .dimension = 2, .nodes = {}});
  ElementBlock vanes{.shape = Shape::quadrilateral,
                     .order = 1,
                     .nodes_per_element = 4,
                     .numbers = {},
                     .nodes = {},
                     .group = {}};
  for (int j = 0; j < n_vanes; ++j) {
    const double angle = first_angle + 2.0 * std::numbers::pi * j / n_vanes;
    const int first = mesh.n_nodes();
    for (const auto& [r, z] : {std::pair{0.08, 0.01}, {0.12, 0.01}, {0.12, 0.03}, {0.08, 0.03}}) {
      mesh.positions.push_back({r * std::cos(angle), r * std::sin(angle), z});
      mesh.node_numbers.push_back(mesh.node_numbers.back() + 1);
    }
    vanes.numbers.push_back(100000 + j);
    for (int k = 0; k < 4; ++k) {
      vanes.nodes.push_back(first + k);
      mesh.groups.back().nodes.push_back(first + k);
    }
    vanes.group.push_back(group);
  }
  mesh.blocks.push_back(vanes);
  return mesh;
}

TEST(OneSector, IsItsOwnImageWhereTheBodyHasOneThatIs)
{
  constexpr int n_vanes = 6;
  for (const double first_angle : {0.0, 0.1, -0.7}) {
    const Mesh whole = disc_with_vanes(first_angle, n_vanes);
    ASSERT_EQ(n_repetitions(whole), n_vanes);
    const Mesh sector = one_sector(whole, n_vanes);
    ASSERT_EQ(sector.blocks[1].n_elements(), 1);
    const auto& vane = sector.positions[std::size_t(sector.blocks[1].element_nodes(0)[0])];
    const double middle = std::atan2(vane[1], vane[0]), half = std::numbers::pi / n_vanes;
    for (const auto& [low, high] : sector.sectors.pairs) {
      const auto& x = sector.positions[std::size_t(low)];
      EXPECT_NEAR(std::remainder(std::atan2(x[1], x[0]) - middle + half, 2.0 * std::numbers::pi),
                  0.0, 1e-9);
    }
    EXPECT_EQ(sector.blocks[0].n_elements() * n_vanes, whole.blocks[0].n_elements());
  }
}

}  // namespace
}  // namespace chladni::mesh
