#include "mesh/gmsh/gmsh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_file_test.hpp"

namespace chladni::mesh {
namespace {

using testing::area;
using testing::MeshFile;

TEST(GradedSizes, GrowWithTheDistanceFromSmallOnes)
{
  const GradedSizes sizes({{.x = {0, 0, 0}, .size = 0.01}, {.x = {1, 0, 0}, .size = 0.2}});
  EXPECT_DOUBLE_EQ(sizes.at({0, 0, 0}), 0.01);
  EXPECT_NEAR(sizes.at({0.1, 0, 0}), 0.05, 1e-15);
  EXPECT_NEAR(sizes.at({0, 0, 0.2}), 0.09, 1e-15);
  EXPECT_DOUBLE_EQ(sizes.at({1, 0, 0}), 0.2);
  EXPECT_NEAR(sizes.at({0.8, 0, 0}), 0.28, 1e-15);
}

TEST(GradedSizes, NeedNoPlacesThatOthersImply)
{
  const GradedSizes sizes({{.x = {0, 0, 0}, .size = 0.01}, {.x = {0.1, 0, 0}, .size = 0.5}});
  EXPECT_NEAR(sizes.at({0.1, 0, 0}), 0.05, 1e-15);
}

/// A square of 2 x 2 in the unit of its file, with elements of 0.4 or, on its right side, as it
/// says.
std::string square_geometry(const std::string& right)
{
  return "Point(1) = {0, 0, 0, 0.4}; Point(2) = {2, 0, 0, " + right + "}; Point(3) = {2, 2, 0, " +
         right +
         "}; Point(4) = {0, 2, 0, 0.4};\nLine(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; "
         "Line(4) = {4, 1};\nCurve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n";
}

/// The number of elements with a corner within a distance of a point.
int elements_at(const Mesh& mesh, const std::array<double, 3>& x, double within)
{
  int n = 0;
  for (const ElementBlock& block : mesh.blocks)
    for (int e = 0; e < block.n_elements(); ++e)
      n += std::ranges::any_of(block.element_nodes(e), [&](int node) {
        const auto& y = mesh.positions[static_cast<std::size_t>(node)];
        return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]) < within;
      });
  return n;
}

TEST_F(MeshFile, HasSmallElementsWhereThatIsAsked)
{
  // In millimetres: Gmsh meshes in the units of the file, whose own sizes its factor scales.
  MeshOptions options{
      .file = write("a.geo", square_geometry("0.4")), .element_order = 1, .length_unit = 1e-3};
  const int n_everywhere = generate(options).blocks.at(0).n_elements();
  options.sizes = {{.x = {0, 0, 0}, .size = 0.02e-3}};
  for (const double factor : {1.0, 2.0}) {
    options.size_factor = factor;
    const Mesh mesh = generate(options);
    EXPECT_NEAR(area(mesh), 4e-6, 1e-15);
    EXPECT_GE(elements_at(mesh, {0, 0, 0}, 0.1e-3), 10) << factor;  // uniform: 1
    EXPECT_LE(elements_at(mesh, {2e-3, 2e-3, 0}, 0.1e-3), 2) << factor;
    EXPECT_LT(mesh.n_nodes(), 30 * n_everywhere) << factor;  // uniform: 400
  }
}

TEST_F(MeshFile, OfAStepHasSmallElementsWhereThatIsAsked)
{
  const std::string file = save("a.step", [] {
    gmsh::model::occ::addRectangle(0, 0, 0, 200, 200);  // mm
    gmsh::model::occ::synchronize();
  });
  MeshOptions options{.file = file, .element_order = 1, .element_size = 0.04};
  EXPECT_LE(elements_at(generate(options), {0, 0, 0}, 0.01), 2);
  options.sizes = {{.x = {0, 0, 0}, .size = 0.002}};
  const Mesh mesh = generate(options);
  EXPECT_NEAR(area(mesh), 0.04, 1e-12);
  EXPECT_GE(elements_at(mesh, {0, 0, 0}, 0.01), 10);
  EXPECT_LE(elements_at(mesh, {0.2, 0.2, 0}, 0.01), 2);
}

TEST_F(MeshFile, KeepsItsOwnSmallElementsBesideThoseThatAreAsked)
{
  MeshOptions options{.file = write("a.geo", square_geometry("0.05")), .element_order = 1};
  const int n_right = elements_at(generate(options), {2, 1, 0}, 0.2);
  options.sizes = {{.x = {0, 0, 0}, .size = 0.1}};
  EXPECT_GE(elements_at(generate(options), {2, 1, 0}, 0.2), 0.8 * n_right);
  options.sizes.clear();
  EXPECT_EQ(elements_at(generate(options), {2, 1, 0}, 0.2), n_right);  // nothing is left in Gmsh
}

}  // namespace
}  // namespace chladni::mesh
