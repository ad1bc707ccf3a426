#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/element_types.hpp"
#include "mesh/generators.hpp"
#include "report/fe/mesh_report.hpp"
#include "report/fe/vtu.hpp"

namespace chladni::report {
namespace {

mesh::Mesh plate(double element_size)
{
  return mesh::rectangle(
      {.length = 2.0, .width = 1.0, .element_size = element_size, .element_order = 3});
}

const GroupParts& parts_of(const mesh::Mesh& mesh, const std::vector<GroupParts>& parts,
                           std::string_view name)
{
  return parts[&mesh::find_group(mesh, std::string(name)) - mesh.groups.data()];
}

TEST(GroupParts, HaveKindSizeAndExtents)
{
  const mesh::Mesh mesh = plate(0.5);
  const std::vector<GroupParts> parts = group_parts(mesh);
  const GroupParts& surface = parts_of(mesh, parts, "plate");
  EXPECT_EQ(surface.kind, GroupKind::surface);
  EXPECT_NEAR(surface.size, 2.0, 1e-12);  // rounding of some ten summands
  const GroupParts& top = parts_of(mesh, parts, "top");
  EXPECT_EQ(top.kind, GroupKind::curve);
  EXPECT_NEAR(top.size, 2.0, 1e-12);
  EXPECT_EQ(top.extents, (std::array<std::array<double, 2>, 3>{{{0, 2}, {1, 1}, {0, 0}}}));
  const GroupParts& corners = parts_of(mesh, parts, "corners");
  EXPECT_EQ(corners.kind, GroupKind::points);
  EXPECT_EQ(corners.points.size(), 4u);
}

TEST(GroupParts, OfNodesApartFromEachOtherArePoints)
{
  const mesh::Mesh mesh =
      mesh::annulus({.inner_radius = 0.1,
                     .outer_radius = 0.2,
                     .element_size = 0.02,
                     .rings = {{.name = "track", .radius = 0.15, .nodes = 24}}});
  const std::vector<GroupParts> parts = group_parts(mesh);
  const GroupParts& track = parts_of(mesh, parts, "track");
  EXPECT_EQ(track.kind, GroupKind::points);
  EXPECT_EQ(track.points.size(), 24u);
  EXPECT_EQ(track.size, 0.0);
  const double circle = 0.4 * std::numbers::pi;
  EXPECT_NEAR(parts_of(mesh, parts, "outer_edge").size, circle, 1e-5 * circle);  // cubic arcs
}

TEST(MeshDrawing, HasTheNodesOfCurvedElementsWhereTheyAreFew)
{
  const mesh::Mesh mesh = plate(0.5);
  const std::vector<GroupParts> parts = group_parts(mesh);
  const MeshDrawing fine = draw_mesh(mesh, parts);
  EXPECT_EQ(fine.detail, Detail::lattice);
  EXPECT_EQ(fine.positions.size(), 3 * mesh.positions.size());
  EXPECT_EQ(fine.group_of_cell.size(), 8u * 9u);
  const MeshDrawing coarse = draw_mesh(mesh, parts, {.lattice = 71, .corners = 8});
  EXPECT_EQ(coarse.detail, Detail::corners);
  EXPECT_EQ(coarse.positions.size(), 3u * 5u * 3u);
  EXPECT_EQ(coarse.group_of_cell.size(), 8u);
  EXPECT_EQ(coarse.edges.size(), 2u * 22u);
}

TEST(MeshDrawing, KeepsToItsLimitAndAllGroupsWhereElementsAreMany)
{
  const mesh::Mesh mesh = plate(0.04);
  const std::vector<GroupParts> parts = group_parts(mesh);
  const MeshDrawing drawing = draw_mesh(mesh, parts, {.lattice = 100, .corners = 200});
  EXPECT_EQ(drawing.detail, Detail::clusters);
  EXPECT_LE(drawing.group_of_cell.size(), 200u);
  EXPECT_GT(drawing.group_of_cell.size(), 50u);
  for (std::size_t k = 0; k < drawing.cells.size(); k += 4) {
    const std::set<int> corners(drawing.cells.begin() + k, drawing.cells.begin() + k + 4);
    EXPECT_GE(corners.size(), 3u) << "a cell without area";
  }
  for (std::size_t g = 0; g < parts.size(); ++g) {
    if (parts[g].kind == GroupKind::surface) continue;
    EXPECT_FALSE(drawing.groups[g].lines.empty() && drawing.groups[g].points.empty())
        << mesh.groups[g].name;
  }
}

TEST(MeshVtu, HasEachNodeOfAnElementOnce)
{
  for (const auto shape : {mesh::Shape::triangle, mesh::Shape::quadrilateral, mesh::Shape::line}) {
    for (const int p : {1, 2, 3, 4}) {
      const int n = shape == mesh::Shape::line       ? p + 1
                    : shape == mesh::Shape::triangle ? (p + 1) * (p + 2) / 2
                                                     : (p + 1) * (p + 1);
      std::vector<int> order = mesh::corners_first(shape, p);
      std::ranges::sort(order);
      std::vector<int> places(n);
      std::iota(places.begin(), places.end(), 0);
      EXPECT_EQ(order, places) << "order " << p;
    }
  }
}

TEST(MeshVtu, EscapesNamesOfGroups)
{
  mesh::Mesh mesh = plate(0.5);
  mesh.groups.front().name = "a\"/><b";
  const std::string text = mesh_vtu(mesh, group_parts(mesh));
  EXPECT_NE(text.find("Name=\"group a&#34;/&#62;&#60;b\""), std::string::npos);
}

TEST(MeshPage, IsEndedByNoNameOfAGroup)
{
  mesh::Mesh mesh = plate(0.5);
  mesh.groups.front().name = "</script>";
  const std::string page = mesh_page("<b>", mesh, group_parts(mesh), {.header = {}, .rows = {}});
  EXPECT_EQ(page.find("\"</script>\""), std::string::npos);
  EXPECT_NE(page.find("\"\\u003c/script>\""), std::string::npos);
}

}  // namespace
}  // namespace chladni::report
