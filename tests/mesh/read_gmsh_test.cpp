#include <gmsh.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/error.hpp"
#include "file_test.hpp"
#include "mesh/generators.hpp"

namespace chladni::mesh {
namespace {

class ReadGmsh : public testing::FileTest {
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
