// Geometries from users' files: parameters, groups, units, rings.
#include <gmsh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::error_of;
using testing::expect_words;
using testing::MeshFile;

const std::string parametric_geo =
    "DefineConstant[ width = 2, n = 3 ];\nheight = 1;\n"
    "Point(1) = {0, 0, 0}; Point(2) = {width, 0, 0};\n"
    "Point(3) = {width, height, 0}; Point(4) = {0, height, 0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
    "Transfinite Curve{1, 3} = n + 1; Transfinite Curve{2, 4} = 2; Transfinite Surface{1};\n";

TEST_F(MeshFile, OfAGeometryTakesParameters)
{
  MeshOptions options{.file = write("a.geo", parametric_geo)};
  EXPECT_NEAR(area(generate(options)), 2.0, 1e-12);
  options.parameters = {{"width", 5.0}, {"n", 4}};
  const Mesh mesh = generate(options);
  EXPECT_NEAR(area(mesh), 5.0, 1e-12);
  EXPECT_EQ(mesh.blocks.at(0).n_elements(), 4);
  options.parameters.clear();
  EXPECT_NEAR(area(generate(options)), 2.0, 1e-12);  // nothing is left behind in Gmsh
}

TEST_F(MeshFile, OfAGeometryNamesAParameterThatItDoesNotTake)
{
  const std::string file = write("a.geo", parametric_geo);
  expect_words(error_of({.file = file, .parameters = {{"widht", 5.0}}}),
               {"a.geo", "no parameter widht"});
  expect_words(error_of({.file = file, .parameters = {{"height", 5.0}}}),
               {"overwrites the parameter height", "DefineConstant[height"});
}

TEST_F(MeshFile, OfAGeometryNamesTheLineOfAMistake)
{
  const std::string file =
      write("a.geo", "Point(1) = {0, 0, 0};\nPoint(2) = {1, 0 0};\nLine(1) = {1, 2};\n");
  expect_words(error_of({.file = file}), {"a.geo", "line 2", "syntax error"});
}

TEST_F(MeshFile, OfAGeometryInMillimetresGetsAHint)
{
  const std::string file = write("a.geo", parametric_geo);
  const MeshOptions wide{.file = file, .parameters = {{"width", 300.0}}};
  const Mesh mesh = generate(wide);
  ASSERT_EQ(mesh.notes.size(), 1U);
  expect_words(mesh.notes[0], {"300 m", "length_unit"});
  MeshOptions ring = wide;
  ring.rings = {{.name = "track", .radius = 0.13, .nodes = 12}};
  expect_words(error_of(ring), {"track", "length_unit"});
  MeshOptions millimetres = wide;
  millimetres.length_unit = 1e-3;
  EXPECT_TRUE(generate(millimetres).notes.empty());
}

TEST_F(MeshFile, OfAGeometryIsNotMeshedByTheAlgorithmThatCrashes)
{
  std::string disc = "Mesh.Algorithm = 8;\nPoint(100) = {0, 0, 0};\n";
  for (int i = 0; i < 60; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 60;
    disc += "Point(" + std::to_string(i + 1) + ") = {" + std::to_string(std::cos(angle)) + ", " +
            std::to_string(std::sin(angle)) + ", 0, 0.1};\n";
  }
  for (int i = 1; i <= 60; ++i) {
    disc += "Line(" + std::to_string(i) + ") = {" + std::to_string(i) + ", " +
            std::to_string(i % 60 + 1) + "};\n";
  }
  disc += "Curve Loop(1) = {1:60}; Plane Surface(1) = {1};\n";
  const Mesh mesh = generate({.file = write("a.geo", disc)});
  ASSERT_EQ(mesh.notes.size(), 1u);
  expect_words(mesh.notes[0], {"Mesh.Algorithm 8", "meshed by 6"});
  const Mesh of_surface =
      generate({.file = write("b.geo", parametric_geo + "MeshAlgorithm Surface {1} = 8;\n")});
  EXPECT_EQ(of_surface.notes.size(), 1u);
  EXPECT_TRUE(generate({.file = write("c.geo", parametric_geo + "// Mesh.Algorithm = 8;\n")})
                  .notes.empty());
  expect_words(error_of({.file = write("d.geo", disc + "Mesh 2;\n")}), {"meshes itself", "d.geo"});
}

TEST_F(MeshFile, OfAGeometryWithoutGroupsHasOneForEachEntity)
{
  const Mesh mesh = generate({.file = write("a.geo", parametric_geo), .element_order = 2});
  EXPECT_EQ(find_group(mesh, "surface_1").nodes.size(), 7u * 3u);
  EXPECT_EQ(find_group(mesh, "curve_4").nodes.size(), 3u);
  EXPECT_EQ(mesh.blocks.at(0).group.at(0), &find_group(mesh, "surface_1") - mesh.groups.data());
}

TEST_F(MeshFile, GetsTheGroupsOfTheScene)
{
  MeshOptions options{.file = write("a.geo", parametric_geo), .element_order = 1};
  options.groups = {
      {"plate", {"surface_1"}}, {"ends", {"curve_2", "curve_4"}}, {"origin", {"point_1"}}};
  const Mesh mesh = generate(options);
  EXPECT_EQ(find_group(mesh, "plate").nodes.size(), 8u);
  EXPECT_EQ(find_group(mesh, "ends").nodes.size(), 4u);
  EXPECT_EQ(find_group(mesh, "origin").nodes.size(), 1u);
  options.groups = {{"plate", {"surface_7"}}};
  expect_words(error_of(options), {"no entity \"surface_7\"", "surface_1", "curve_4"});
  options.groups = {{"plate", {"surface_1", "curve_4"}}};
  expect_words(error_of(options), {"\"plate\" mixes"});
  options.groups = {{"plate", {"surface_1"}}, {"other", {"surface_1"}}};
  expect_words(error_of(options), {"\"other\"", "belongs to the group \"plate\" already"});
}

TEST_F(MeshFile, IsScaledToMetres)
{
  const Mesh mesh =
      generate({.file = write("a.geo", parametric_geo), .element_order = 1, .length_unit = 1e-3});
  EXPECT_NEAR(area(mesh), 2e-6, 1e-18);
}

TEST_F(MeshFile, OfStepIsInMetresAndOnePiece)
{
  // Two faces of a step, not sewn: one upright on the middle of the other.
  const std::string file = save("a.step", [] {
    gmsh::model::occ::addRectangle(0, 0, 0, 200, 100);
    const int wall = gmsh::model::occ::addRectangle(0, 0, 0, 50, 100);
    gmsh::model::occ::rotate({{2, wall}}, 0, 0, 0, 0, 1, 0, -std::numbers::pi / 2);
    gmsh::model::occ::translate({{2, wall}}, 100, 0, 0);
    gmsh::model::occ::synchronize();
  });
  MeshOptions options{.file = file, .element_order = 2, .element_size = 0.025};
  const Mesh mesh = generate(options);
  EXPECT_NEAR(area(mesh), 0.2 * 0.1 + 0.05 * 0.1, 1e-9);
  const auto& wall = find_group(mesh, "surface_2").nodes;
  const auto& plate = find_group(mesh, "surface_1").nodes;
  std::vector<int> common;
  std::ranges::set_intersection(wall, plate, std::back_inserter(common));
  const auto on_joint = [](const std::array<double, 3>& x) {
    return std::hypot(x[0] - 0.1, x[2]) < 1e-9;
  };
  EXPECT_EQ(std::ssize(common), std::ranges::count_if(mesh.positions, on_joint));
  EXPECT_GE(common.size(), 9u);  // four edges of order 2 at 25 mm
  options.groups = {{"plate", {"surface_1"}}, {"wall", {"surface_2"}}};
  EXPECT_EQ(find_group(generate(options), "wall").nodes.size(), wall.size());
}

TEST_F(MeshFile, OfStepGetsItsRingsOnItsFlatPart)
{
  const std::string file = save("a.step", [] {
    gmsh::model::occ::addDisk(0, 0, 10, 160, 160);
    gmsh::model::occ::synchronize();
  });
  const Mesh mesh =
      generate({.file = file,
                .element_order = 3,
                .element_size = 0.03,
                .rings = {{.name = "track", .radius = 0.13, .nodes = 24, .z = 0.01}}});
  const Group& track = find_group(mesh, "track");
  ASSERT_EQ(track.nodes.size(), 24u);
  for (int i = 0; i < 24; ++i) {
    const auto& x = mesh.positions[track.nodes[i]];
    EXPECT_EQ(x[0], 0.13 * std::cos(2.0 * std::numbers::pi * i / 24));
    EXPECT_EQ(x[1], 0.13 * std::sin(2.0 * std::numbers::pi * i / 24));
  }
  EXPECT_EQ(find_group(mesh, "surface_1").nodes.size(), mesh.positions.size());
}

TEST_F(MeshFile, OfStepWithASolidIsRefused)
{
  const std::string file = save("a.step", [] {
    gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
    gmsh::model::occ::synchronize();
  });
  expect_words(error_of({.file = file, .element_size = 0.1}),
               {"1 solids", "volume_1", "mid-surface"});
}

/// A ring of 60 by 160 mm, 20 mm thick, on a block.
TEST_F(MeshFile, OfStepWithVolumesIsOfSolidsThatMeet)
{
  const std::string file = save("a.step", [] {
    const int outer = gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, 20, 160);
    const int inner = gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, 20, 60);
    std::vector<std::pair<int, int>> all;
    std::vector<std::vector<std::pair<int, int>>> parts;
    gmsh::model::occ::cut({{3, outer}}, {{3, inner}}, all, parts);
    gmsh::model::occ::addBox(80, -30, -30, 60, 60, 30);
    gmsh::model::occ::synchronize();
  });
  const Mesh mesh = generate({.file = file,
                              .element_size = 0.03,
                              .rings = {{.name = "top", .radius = 0.13, .nodes = 24, .z = 0.02}},
                              .solid_groups = {"volume_1", "volume_2"}});
  ASSERT_EQ(mesh.blocks.size(), 1U);
  EXPECT_EQ(mesh.blocks[0].shape, Shape::tetrahedron);
  EXPECT_EQ(mesh.blocks[0].order, 2);
  const Group &ring = find_group(mesh, "volume_1"), &block = find_group(mesh, "volume_2");
  EXPECT_EQ(ring.dimension, 3);
  std::vector<int> common;
  std::ranges::set_intersection(ring.nodes, block.nodes, std::back_inserter(common));
  EXPECT_GE(common.size(), 20U) << "the block is joined to the ring";
  for (const int node : common) EXPECT_NEAR(mesh.positions[std::size_t(node)][2], 0.0, 1e-9);
  const Group& top = find_group(mesh, "top");
  ASSERT_EQ(top.nodes.size(), 24U);
  EXPECT_EQ(mesh.positions[std::size_t(top.nodes[6])][1], 0.13);
  expect_words(error_of({.file = file, .element_size = 0.03, .shell_groups = {"surface_1"}}),
               {"2 solids", "volume_1"});
}

TEST_F(MeshFile, OfPyramidsIsRefusedByElement)
{
  const std::string file =
      write("a.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n"
            "$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
            "5 0.5 0.5 1\n$EndNodes\n$Elements\n1\n17 7 2 1 1 1 2 3 4 5\n$EndElements\n");
  expect_words(error_of({.file = file, .solid_groups = {"body"}}),
               {"a.msh", "element 17", "Pyramid 5", "with tetrahedra"});
}

/// 30 degrees of a ring with a hole nearer to one of the cuts.
void add_sector_of_a_ring()
{
  namespace occ = gmsh::model::occ;
  const int outer = occ::addCylinder(0, 0, 0, 0, 0, 20, 160, -1, std::numbers::pi / 6);
  const int inner = occ::addCylinder(0, 0, 0, 0, 0, 20, 60, -1, std::numbers::pi / 6);
  const int hole = occ::addCylinder(95, 17, -10, 10, 10, 40, 8);
  std::vector<std::pair<int, int>> all;
  std::vector<std::vector<std::pair<int, int>>> parts;
  occ::cut({{3, outer}}, {{3, inner}, {3, hole}}, all, parts);
  occ::synchronize();
}

TEST_F(MeshFile, OfStepWithASectorHasCutsThatMatch)
{
  MeshOptions options{.file = save("a.step", add_sector_of_a_ring),
                      .element_size = 0.03,
                      .rings = {{.name = "top", .radius = 0.13, .nodes = 48, .z = 0.02}},
                      .solid_groups = {"volume_1"},
                      .sectors = 12};
  const Mesh mesh = generate(options);
  // Each cut is 100 mm x 20 mm: 8 corners of elements and as many edges at least.
  EXPECT_GE(mesh.sectors.pairs.size(), 16U);
  for (const auto& [low, high] : mesh.sectors.pairs) {
    EXPECT_NEAR(mesh.positions[std::size_t(low)][1], 0.0, 1e-9);
    EXPECT_NEAR(mesh.positions[std::size_t(high)][1],
                std::tan(std::numbers::pi / 6) * mesh.positions[std::size_t(high)][0], 1e-9);
  }
  EXPECT_EQ(find_group(mesh, "top").nodes.size(), 5U) << "four of 48, and the second end";
  // The ring cuts a face, and Gmsh gives others new numbers; groups stay those of the file.
  std::vector<std::array<int, 4>> lies_on;  // z = 0 and 0.02 m, r = 0.06 and 0.16 m
  for (const Group& group : mesh.groups) {
    if (group.dimension != 2) continue;
    lies_on.push_back({1, 1, 1, 1});
    for (const int node : group.nodes) {
      const auto& [x, y, z] = mesh.positions[std::size_t(node)];
      const double r = std::hypot(x, y);
      const std::array away{z, z - 0.02, r - 0.06, r - 0.16};
      for (std::size_t k = 0; k < 4; ++k)
        if (std::abs(away[k]) > 1e-9) lies_on.back()[k] = 0;
    }
  }
  EXPECT_EQ(lies_on.size(), 7U) << "two cuts and a hole besides";
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(std::ranges::count_if(lies_on, [&](const auto& on) { return on[k]; }), 1) << k;
  options.sectors = 11;
  expect_words(error_of(options), {"sectors = 11", "no node"});
}

}  // namespace
}  // namespace chladni::mesh
