#include <gtest/gtest.h>

#include <numbers>

#include "cli/scene/scene.hpp"
#include "common/error.hpp"

namespace chladni::cli {
namespace {

/// A scene with this [mesh] and a section for `group`.
std::string scene_of(const std::string& mesh, const std::string& group)
{
  return "[mesh]\n" + mesh + R"([material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
type = "shell"
material = "iron"
thickness = 0.02
group = ")" +
         group + "\"\n[interface]\nnodes = [\"" + (group == "plate" ? "right" : "outer_edge") +
         "\"]\n[reduce]\nmethod = \"craig-bampton\"\nmodes = 9\n";
}

mesh::MeshOptions options_of(const std::string& mesh, const std::string& group)
{
  return parse_scene(scene_of(mesh, group), "folder/scene.toml").mesh;
}

std::string error_of(const std::string& mesh, const std::string& group = "disc")
{
  try {
    parse_scene(scene_of(mesh, group), "scene.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Lines 2 to 8.
const std::string hat = R"(generator = "hat_disc"
wall_radius = 0.08
outer_radius = 0.16
hub_radius = 0.03
height = 0.05
element_size = 0.02
rings = [{ name = "track", radius = 0.13, nodes = 60 }]
)";

TEST(SceneMesh, HoldsTheHatDiscWithItsDefaults)
{
  const auto options = options_of(hat, "flange").hat_disc;
  ASSERT_TRUE(options);
  EXPECT_EQ(options->inner_radius, 0.08);
  EXPECT_EQ(options->top_radius, 0.08);
  EXPECT_EQ(options->foot, 0.0);
  EXPECT_EQ(options->element_order, 3);
  EXPECT_EQ(options->pattern, mesh::Pattern::structured);
  EXPECT_FALSE(options->edge_row);
  EXPECT_EQ(options->rings.at(0).nodes, 60);
}

TEST(SceneMesh, HoldsTheHatDiscAsTold)
{
  const auto options = options_of(hat +
                                      "inner_radius = 0.07\ntop_radius = 0.06\nfoot = 0.01\n"
                                      "edge_row = 0.004\nelement_order = 4\n"
                                      "bolts = { count = 5, circle_radius = 0.045, "
                                      "hole_radius = 0.006 }\n",
                                  "wall")
                           .hat_disc;
  ASSERT_TRUE(options && options->bolts);
  EXPECT_EQ(options->inner_radius, 0.07);
  EXPECT_EQ(options->top_radius, 0.06);
  EXPECT_EQ(options->foot, 0.01);
  EXPECT_EQ(options->edge_row, 0.004);
  EXPECT_EQ(options->element_order, 4);
  EXPECT_EQ(options->pattern, mesh::Pattern::unstructured);  // holes leave no choice
  EXPECT_EQ(options->bolts->count, 5);
  EXPECT_EQ(options->bolts->circle_radius, 0.045);
  EXPECT_EQ(options->bolts->hole_radius, 0.006);
}

TEST(SceneMesh, HoldsThePadInRadians)
{
  const auto options = options_of(
      "generator = \"pad\"\ninner_radius = 0.1\nouter_radius = 0.15\nangle_deg = 60.0\n"
      "centre_deg = 90.0\nelement_size = 0.01\npattern = \"triangles\"\n",
      "pad");
  ASSERT_TRUE(options.pad);
  EXPECT_DOUBLE_EQ(options.pad->angle, std::numbers::pi / 3.0);
  EXPECT_DOUBLE_EQ(options.pad->centre_angle, std::numbers::pi / 2.0);
  EXPECT_EQ(options.pad->pattern, mesh::Pattern::triangles);
}

TEST(SceneMesh, HoldsTheRectangle)
{
  const auto options = options_of(
      "generator = \"rectangle\"\nlength = 0.3\nwidth = 0.2\nelement_size = 0.05\n"
      "edge_row = 0.01\n",
      "plate");
  ASSERT_TRUE(options.rectangle);
  EXPECT_EQ(options.rectangle->length, 0.3);
  EXPECT_EQ(options.rectangle->width, 0.2);
  EXPECT_EQ(options.rectangle->edge_row, 0.01);
}

TEST(SceneMeshError, NamesWhatAGeneratorDoesNotAdmit)
{
  EXPECT_EQ(error_of("generator = \"sphere\"\n"),
            "scene.toml:2: mesh.generator = \"sphere\": must be one of \"annulus\", \"hat_disc\", "
            "\"pad\", \"rectangle\", \"beam\"");
  EXPECT_EQ(error_of(hat + "inner_radius = 0.09\n"),
            "scene.toml:9: mesh.inner_radius = 0.09: must be > 0 and <= 0.08 (m)");
  EXPECT_EQ(error_of(hat + "foot = 0.05\n"),
            "scene.toml:9: mesh.foot = 0.05: must be >= 0 and < 0.05 (m)");
  EXPECT_EQ(error_of(hat + "edge_row = 0.04\n"),
            "scene.toml:9: mesh.edge_row = 0.04: must be > 0 and < 0.04 (m, half of the width)");
  EXPECT_EQ(error_of(hat + "pattern = \"spiral\"\n"),
            "scene.toml:9: mesh.pattern = \"spiral\": must be one of \"structured\", "
            "\"unstructured\", \"triangles\"");
  EXPECT_EQ(error_of(hat + "pattern = \"structured\"\nbolts = { count = 5 }\n").substr(0, 24),
            "scene.toml:10: mesh.bolt");
  EXPECT_NE(error_of(hat, "plate").find("there are: \"disc\", \"wall\", \"flange\""),
            std::string::npos);
  EXPECT_NE(error_of("generator = \"rectangle\"\nlength = 0.3\nwidth = 0.2\nelement_size = 0.25\n")
                .find("element_size = 0.25"),
            std::string::npos);
  EXPECT_NE(error_of("generator = \"pad\"\ninner_radius = 0.1\nouter_radius = 0.15\n"
                     "angle_deg = 180.0\nelement_size = 0.01\n")
                .find("angle_deg = 180"),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::cli
