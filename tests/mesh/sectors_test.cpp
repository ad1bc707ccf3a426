#include "mesh/sectors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

AnnulusOptions annulus_of(int sectors)
{
  return {.inner_radius = 0.05,
          .outer_radius = 0.15,
          .element_size = 0.02,
          .element_order = 3,
          .rings = {{.name = "track", .radius = 0.12, .nodes = 24}},
          .pattern = Pattern::structured,
          .sectors = sectors};
}

std::string message_of(Mesh mesh, int count)
{
  try {
    find_sector_edges(mesh, count);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Sector, OfAnAnnulusHasTheNodesOfTheWholeOne)
{
  const Mesh whole = annulus(annulus_of(1)), sector = annulus(annulus_of(12));
  const auto n_pairs = std::ssize(sector.sectors.pairs);
  EXPECT_EQ(whole.n_nodes(), 12 * (sector.n_nodes() - n_pairs));
  EXPECT_EQ(find_group(sector, "track").nodes.size(), 3u) << "two nodes and that of the next one";
  for (const auto& [low, high] : sector.sectors.pairs) {
    const auto x = turned(sector.sectors, sector.positions[std::size_t(low)]);
    EXPECT_EQ(x, sector.positions[std::size_t(high)]);
  }
}

TEST(Sector, HasTheElementsAroundDividedAndRefusesARingThatIsNot)
{
  AnnulusOptions options = annulus_of(7);
  EXPECT_THROW(annulus(options), Error) << "24 nodes do not repeat seven times";
  options.rings.clear();
  EXPECT_NO_THROW(annulus(options)) << "elements around are a multiple of the sectors";
}

TEST(Sector, NamesTheDistanceOfEdgesThatDoNotMatch)
{
  Mesh mesh = annulus(annulus_of(12));
  // Corners of the second edge, all but its ends, move along it.
  for (const auto& [low, high] : mesh.sectors.pairs) {
    auto& x = mesh.positions[std::size_t(high)];
    const double radius = std::hypot(x[0], x[1]);
    if (radius < 0.06 || radius > 0.14) continue;
    for (std::size_t c = 0; c < 2; ++c) x[c] *= 1.0 + 2e-3 / radius;
  }
  const std::string message = message_of(mesh, 12);
  EXPECT_NE(message.find("do not match"), std::string::npos) << message;
  EXPECT_NE(message.find("0.002 m away"), std::string::npos) << message;
}

TEST(Sector, NamesANodeOfTheSecondEdgeThatTheFirstDoesNotHave)
{
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 1.5, 0}, {0, 1, 0}};
  mesh.node_numbers = {1, 2, 3, 4, 5};
  mesh.groups = {{.name = "disc", .dimension = 2, .nodes = {0, 1, 2, 3, 4}}};
  mesh.blocks = {{.shape = Shape::triangle,
                  .order = 1,
                  .nodes_per_element = 3,
                  .numbers = {1, 2, 3},
                  .nodes = {0, 1, 3, 1, 2, 3, 0, 3, 4},
                  .group = {0, 0, 0}}};
  const std::string message = message_of(mesh, 4);
  EXPECT_NE(message.find("do not match: node 4 (0, 1.5, 0), turned"), std::string::npos) << message;
}

/// A quarter of a block around the z axis, whose second cut face has a node more than the first.
/// @param angle  of the edge between its two parts, rad
Mesh quarter_of_wedges(double angle)
{
  Mesh mesh;
  for (const double z : {0.0, 1.0}) {
    mesh.positions.insert(mesh.positions.end(), {{1, 0, z}, {2, 0, z}, {0, 2, z}});
    mesh.positions.push_back({1.4 * std::cos(angle), 1.4 * std::sin(angle), z});
    mesh.positions.push_back({0, 1, z});
  }
  for (int i = 1; i <= 10; ++i) mesh.node_numbers.push_back(i);
  mesh.blocks = {{.shape = Shape::wedge,
                  .order = 1,
                  .nodes_per_element = 6,
                  .numbers = {1, 2, 3},
                  .nodes = {0, 1, 3, 5, 6, 8, 1, 2, 3, 6, 7, 8, 0, 3, 4, 5, 8, 9},
                  .group = {-1, -1, -1}}};
  return mesh;
}

TEST(Sector, NamesANodeOfTheSecondFaceThatTheFirstDoesNotHave)
{
  const std::string message = message_of(quarter_of_wedges(0.5 * std::numbers::pi), 4);
  EXPECT_NE(message.find("the cut faces do not match: node 4 (8.57253e-17, 1.4, 0)"),
            std::string::npos)
      << message;
  // A twentieth of a side off the face it is none of it.
  EXPECT_EQ(message_of(quarter_of_wedges(0.4 * std::numbers::pi), 4), "");
}

TEST(Sector, HasItsSecondEdgeMovedOntoTheTurnedFirstWithANote)
{
  for (const double off : {1e-12, 3e-6}) {
    Mesh mesh = annulus(annulus_of(12));
    mesh.notes.clear();
    for (const auto& [low, high] : mesh.sectors.pairs) mesh.positions[std::size_t(high)][2] += off;
    find_sector_edges(mesh, 12);
    for (const auto& [low, high] : mesh.sectors.pairs)
      EXPECT_EQ(mesh.positions[std::size_t(high)][2], 0.0);
    ASSERT_EQ(mesh.notes.size(), off > 1e-9 ? 1u : 0u);
    if (off < 1e-9) continue;
    EXPECT_NE(mesh.notes[0].find("by 3e-06 m at most"), std::string::npos) << mesh.notes[0];
  }
}

TEST(Sector, IsRefusedWhereTheMeshIsWider)
{
  const Mesh mesh = annulus(annulus_of(12));
  EXPECT_NE(message_of(mesh, 24).find("wider than one sector"), std::string::npos);
}

TEST(Sector, IsRefusedWhereNothingMeets)
{
  const Mesh mesh = annulus(annulus_of(12));
  EXPECT_NE(message_of(mesh, 5).find("no node of the mesh meets"), std::string::npos);
}

}  // namespace
}  // namespace chladni::mesh
