#include <gmsh.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/error.hpp"
#include "mesh/generators.hpp"
#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::error_of;
using testing::expect_words;

class ReadGmsh : public testing::MeshFile {
 protected:
  /// A strip of 3 x 2 rectangles 3 m x 1 m in a format of Gmsh.
  std::string write_strip(const std::string& name, double format, bool binary, int order = 2) const
  {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::open(write("strip.geo", strip_geo));
    gmsh::model::mesh::generate(2);
    gmsh::model::mesh::setOrder(order);
    gmsh::option::setNumber("Mesh.MshFileVersion", format);
    gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
    gmsh::write(path(name));
    gmsh::finalize();
    return path(name);
  }

  static constexpr const char* strip_geo =
      "Point(1) = {0, 0, 0}; Point(2) = {3, 0, 0}; Point(3) = {3, 1, 0}; Point(4) = {0, 1, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
      "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
      "Transfinite Curve{1, 3} = 4; Transfinite Curve{2, 4} = 3; Transfinite Surface{1};\n"
      "Recombine Surface{1};\n"
      "Physical Surface(\"strip\") = {1}; Physical Curve(\"left\") = {4};\n";
};

MeshOptions file_options(const std::string& file)
{
  return {.annulus = {}, .file = file, .element_order = {}, .rings = {}};
}

void expect_strip(const Mesh& mesh)
{
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].n_elements(), 6);
  EXPECT_EQ(mesh.blocks[0].order, 2);
  EXPECT_EQ(mesh.n_nodes(), 7 * 5);
  EXPECT_EQ(find_group(mesh, "left").nodes.size(), 5u);
  EXPECT_EQ(find_group(mesh, "strip").nodes.size(), 35u);
}

TEST_F(ReadGmsh, ReadsVersion22)
{
  expect_strip(generate(file_options(write_strip("a.msh", 2.2, false))));
}
TEST_F(ReadGmsh, ReadsVersion22Binary)
{
  expect_strip(generate(file_options(write_strip("a.msh", 2.2, true))));
}
TEST_F(ReadGmsh, ReadsVersion41)
{
  expect_strip(generate(file_options(write_strip("a.msh", 4.1, false))));
}
TEST_F(ReadGmsh, ReadsVersion41Binary)
{
  expect_strip(generate(file_options(write_strip("a.msh", 4.1, true))));
}

TEST_F(ReadGmsh, ReadsEachOrderOfAFile)
{
  for (const int order : {1, 2, 3, 4}) {
    const Mesh mesh = generate(file_options(write_strip("a.msh", 4.1, true, order)));
    ASSERT_EQ(mesh.blocks.size(), 1u);
    EXPECT_EQ(mesh.blocks[0].order, order);
    EXPECT_EQ(mesh.n_nodes(), (3 * order + 1) * (2 * order + 1));
  }
}

TEST_F(ReadGmsh, MeshesAGeometryAtTheOrderAsked)
{
  MeshOptions options = file_options(write("strip.geo", strip_geo));
  options.element_order = 3;
  const Mesh mesh = generate(options);
  EXPECT_EQ(mesh.blocks.at(0).order, 3);
  EXPECT_EQ(mesh.n_nodes(), 10 * 7);
  options.element_order = 1;
  EXPECT_EQ(generate(options).n_nodes(), 4 * 3);
}

TEST_F(ReadGmsh, KeepsTheLinesOfLineGroupsOnly)
{
  MeshOptions options = file_options(write_strip("a.msh", 4.1, false));
  options.line_groups = {"left"};
  const Mesh mesh = generate(options);
  ASSERT_EQ(mesh.blocks.size(), 2u);
  const ElementBlock& lines = mesh.blocks[0];
  ASSERT_EQ(lines.shape, Shape::line);
  ASSERT_EQ(lines.n_elements(), 2);
  EXPECT_EQ(lines.order, 2);
  EXPECT_EQ(mesh.groups[lines.group[0]].name, "left");
  // From end to end: the middle node stands in the middle. Gmsh divides a curve to some 1e-12.
  for (int e = 0; e < 2; ++e) {
    const auto y = [&](int i) { return mesh.positions[lines.element_nodes(e)[i]][1]; };
    EXPECT_NEAR(y(1), 0.5 * (y(0) + y(2)), 1e-11);
    EXPECT_NEAR(std::abs(y(2) - y(0)), 0.5, 1e-11);
  }
  EXPECT_EQ(mesh.n_nodes(), 35);  // shared with the surface
}

TEST_F(ReadGmsh, MeshesAGeometryOfCurvesAlone)
{
  MeshOptions options = file_options(write(
      "frame.geo",
      "Point(1) = {0, 0, 0}; Point(2) = {3, 0, 0}; Line(1) = {1, 2}; Transfinite Curve{1} = 4;\n"
      "Physical Curve(\"bar\") = {1}; Physical Curve(\"too\") = {1}; Physical Point(\"tip\") = "
      "{2};\n"));
  options.line_groups = {"too"};  // not the first group of its curve
  const Mesh mesh = generate(options);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].n_elements(), 3);
  EXPECT_EQ(mesh.n_nodes(), 10);  // order 3 unless told otherwise
  EXPECT_EQ(find_group(mesh, "tip").nodes.size(), 1u);
  options.line_groups = {};
  EXPECT_THROW(generate(options), Error);
}

/// A strip of 3 by 2 quadrilaterals, of which those beyond x = 1 are in the group "outboard" too.
/// Version 2.2 has them once for each group.
TEST_F(ReadGmsh, HasAnElementOfTwoGroupsOnce)
{
  const std::string geo =
      "Point(1)={0,0,0};Point(2)={1,0,0};Point(3)={3,0,0};Point(4)={3,1,0};Point(5)={1,1,0};"
      "Point(6)={0,1,0};Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,5};Line(5)={5,6};"
      "Line(6)={6,1};Line(7)={2,5};Curve Loop(1)={1,7,5,6};Curve Loop(2)={2,3,4,-7};"
      "Plane Surface(1)={1};Plane Surface(2)={2};Transfinite Curve{1,5}=2;"
      "Transfinite Curve{2,3,4,6,7}=3;Transfinite Surface{1,2};Recombine Surface{1,2};"
      "Physical Surface(\"outboard\")={2};Physical Surface(\"plate\")={1,2};\n";
  for (const double version : {2.2, 4.1}) {
    const std::string file = save("twice.msh", [&] {
      gmsh::open(write("twice.geo", geo));
      gmsh::model::mesh::generate(2);
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
    });
    MeshOptions options = file_options(file);
    options.shell_groups = {"plate"};
    const Mesh mesh = generate(options);
    const ElementBlock& block = mesh.blocks.at(0);
    EXPECT_EQ(block.n_elements(), 6) << version;
    EXPECT_NEAR(area(mesh), 3.0, 1e-12) << version;
    EXPECT_EQ(find_group(mesh, "outboard").nodes.size(), 9U) << version;
    for (const int group : block.group) EXPECT_EQ(mesh.groups[std::size_t(group)].name, "plate");
    options.shell_groups = {"plate", "outboard"};
    expect_words(error_of(options), {"outboard", "plate", "section"});
  }
}

TEST_F(ReadGmsh, NamesGroupsOfOneNumberByTheirKind)
{
  const std::string file =
      write("same.geo", std::string(strip_geo) +
                            "Physical Surface(9) = {1}; Physical Curve(9) = {1}; Physical Point(9) "
                            "= {1}; Physical Curve(10) = {2};\n");
  MeshOptions options = file_options(file);
  options.element_order = 1;
  options.line_groups = {"9_lines"};
  const Mesh mesh = generate(options);
  EXPECT_EQ(find_group(mesh, "9").dimension, 2);
  EXPECT_EQ(find_group(mesh, "9").nodes.size(), 12U);
  EXPECT_EQ(find_group(mesh, "9_lines").nodes.size(), 4U);
  EXPECT_EQ(find_group(mesh, "9_nodes").nodes.size(), 1U);
  EXPECT_EQ(find_group(mesh, "10").dimension, 1);
  EXPECT_EQ(mesh.blocks.size(), 2U) << "lines and surfaces";
}

TEST_F(ReadGmsh, ObeysTheLastStatementOfAFileWhoseLastLineDoesNotEnd)
{
  MeshOptions options =
      file_options(write("strip.geo", std::string(strip_geo) + "Physical Curve(\"last\") = {2};"));
  EXPECT_EQ(find_group(generate(options), "last").dimension, 1);
}

/// An arc of 120 degrees whose middle is beyond the opposite side: of order 1 the element ends at
/// its chord.
TEST_F(ReadGmsh, SaysThatALowerOrderHelpsWhereAnArcFoldsAnElement)
{
  MeshOptions options = file_options(
      write("arc.geo",
            "Point(1)={-.866025,.5,0};Point(2)={.866025,.5,0};Point(3)={1,.6,0};Point(4)={-1,.6,0};"
            "Point(5)={0,0,0};"
            "Circle(1)={1,5,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};Curve Loop(1)={1,2,3,4};"
            "Plane Surface(1)={1};Transfinite Curve{1,2,3,4}=2;Transfinite Surface{1};Recombine "
            "Surface{1};"
            "Physical Surface(\"plate\")={1};\n"));
  options.element_order = 1;
  EXPECT_EQ(generate(options).n_nodes(), 4);
  options.element_order = 3;
  expect_words(error_of(options), {"degenerate or folded", "element_order = 2 in [mesh]"});
}

TEST_F(ReadGmsh, KnowsFilesByNamesInCapitals)
{
  const auto named = [&](const std::string& file, const std::string& name) {
    std::filesystem::copy_file(file, path(name), std::filesystem::copy_options::overwrite_existing);
    return file_options(path(name));
  };
  expect_strip(generate(named(write_strip("a.msh", 2.2, false), "A.MSH")));
  MeshOptions geo = named(write("strip.geo", strip_geo), "STRIP.Geo");
  geo.element_order = 1;
  EXPECT_EQ(generate(geo).n_nodes(), 12);
  const std::string deck =
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,1.,0.\nGRID,4,,0.,1.,0.\n"
      "CQUAD4,1,7,1,2,3,4\n";
  for (const char* name : {"A.BDF", "A.DAT", "a.Nas"})
    EXPECT_EQ(generate(file_options(write(name, deck))).n_nodes(), 4) << name;
  const std::string input = "*Node\n1, 0.\n2, 2.\n3, 2., 1.\n*Element, type=S3\n1, 1, 2, 3\n";
  EXPECT_EQ(generate(file_options(write("A.INP", input))).n_nodes(), 3);
}

TEST_F(ReadGmsh, NamesAFileThatIsMissing)
{
  try {
    generate(file_options(path("absent.msh")));
    FAIL() << "a missing file is read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("absent.msh does not exist"), std::string::npos);
  }
}

TEST_F(ReadGmsh, RefusesATruncatedFile)
{
  const std::string file = write_strip("a.msh", 4.1, false);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_THROW(generate(file_options(file)), Error);
}

TEST_F(ReadGmsh, NamesARingThatNoNodeMeets)
{
  MeshOptions options = file_options(write_strip("a.msh", 4.1, false));
  options.rings = {{.name = "track", .radius = 0.4, .nodes = 8}};
  EXPECT_THROW(generate(options), Error);
}

}  // namespace
}  // namespace chladni::mesh
