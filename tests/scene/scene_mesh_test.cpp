#include <gtest/gtest.h>

#include <numbers>

#include "scene/scene.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::error_of;

/// A scene with this [mesh] and a section for `group`.
std::string scene_of_mesh(const std::string& mesh, const std::string& group)
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
  return parse_scene(scene_of_mesh(mesh, group), "folder/scene.toml").mesh;
}

std::string mesh_error(const std::string& mesh, const std::string& group = "disc")
{
  return error_of(scene_of_mesh(mesh, group));
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

TEST(SceneMesh, KnowsTheEdgesOfAPad)
{
  const std::string pad =
      "generator = \"pad\"\ninner_radius = 0.1\nouter_radius = 0.15\nangle_deg = 60.0\n"
      "centre_deg = 90.0\nelement_size = 0.01\n";
  const std::string error = error_of(
      test::replaced(scene_of_mesh(pad, "pad"), "nodes = [\"outer_edge\"]", "nodes = [\"rim\"]"));
  const char* groups = "\"inner_edge\", \"outer_edge\", \"first_edge\", \"last_edge\", \"corners\"";
  EXPECT_NE(error.find(groups), std::string::npos) << error;
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
  EXPECT_EQ(mesh_error("generator = \"sphere\"\n"),
            "scene.toml:2: mesh.generator = \"sphere\": must be one of \"annulus\", \"hat_disc\", "
            "\"pad\", \"rectangle\", \"beam\"");
  EXPECT_EQ(mesh_error(hat + "inner_radius = 0.09\n"),
            "scene.toml:9: mesh.inner_radius = 0.09: must be > 0 and <= 0.08 (m)");
  EXPECT_EQ(mesh_error(hat + "foot = 0.05\n"),
            "scene.toml:9: mesh.foot = 0.05: must be >= 0 and < 0.05 (m)");
  EXPECT_EQ(mesh_error(hat + "edge_row = 0.04\n"),
            "scene.toml:9: mesh.edge_row = 0.04: must be > 0 and < 0.04 (m, half of the width)");
  EXPECT_EQ(mesh_error(hat + "pattern = \"spiral\"\n"),
            "scene.toml:9: mesh.pattern = \"spiral\": must be one of \"structured\", "
            "\"unstructured\", \"triangles\"");
  EXPECT_EQ(mesh_error(hat + "pattern = \"structured\"\nbolts = { count = 5 }\n").substr(0, 24),
            "scene.toml:10: mesh.bolt");
  EXPECT_NE(mesh_error(hat, "plate").find("there are: \"disc\", \"wall\", \"flange\""),
            std::string::npos);
  EXPECT_NE(
      mesh_error("generator = \"rectangle\"\nlength = 0.3\nwidth = 0.2\nelement_size = 0.25\n")
          .find("element_size = 0.25"),
      std::string::npos);
  EXPECT_NE(mesh_error("generator = \"pad\"\ninner_radius = 0.1\nouter_radius = 0.15\n"
                       "angle_deg = 180.0\nelement_size = 0.01\n")
                .find("angle_deg = 180"),
            std::string::npos);
}

/// With an accuracy: no size of elements and no [reduce], or what `changes` say.
std::string accurate(const std::string& mesh = "", const std::string& rest = "")
{
  return R"(accuracy = { error = 1e-3, up_to_Hz = 8000.0 }
[mesh]
generator = "annulus"
inner_radius = 0.02
outer_radius = 0.16
)" + mesh +
         R"([material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
type = "shell"
material = "iron"
thickness = 0.02
group = "disc"
[interface]
nodes = ["outer_edge"]
)" + rest;
}

TEST(SceneAccuracy, StandsForMeshAndReduction)
{
  const Scene scene = parse_scene(accurate(), "scene.toml");
  ASSERT_TRUE(scene.accuracy);
  EXPECT_EQ(scene.accuracy->error, 1e-3);
  EXPECT_TRUE(scene.accuracy->chooses_order && scene.accuracy->chooses_edge_row);
  EXPECT_TRUE(scene.mesh_errors);
  EXPECT_EQ(scene.mesh.annulus->element_size, 0.0);
  EXPECT_EQ(scene.mesh.annulus->pattern, mesh::Pattern::structured);
  EXPECT_EQ(scene.reduce.method, reduce::Method::automatic);
  EXPECT_EQ(scene.reduce.tolerance->up_to_Hz, 8000.0);
  EXPECT_LT(scene.reduce.tolerance->tolerance, 1e-3);
  EXPECT_EQ(scene.body.keep.tolerance->error, 1e-3);
  const Scene said = parse_scene(accurate("element_order = 2\nedge_row = 0.01\n",
                                          "[reduce]\nmethod = \"craig-bampton\"\nmesh_errors = "
                                          "false\n[body]\nkeep = { modes = 7 }\n"),
                                 "scene.toml");
  EXPECT_FALSE(said.accuracy->chooses_order || said.accuracy->chooses_edge_row);
  EXPECT_EQ(said.reduce.method, reduce::Method::craig_bampton);
  EXPECT_FALSE(said.mesh_errors);
  EXPECT_EQ(said.body.keep.count, 7);
}

TEST(SceneAccuracy, OfSolidsLeavesTheirMeshToTheScene)
{
  std::string text = accurate("element_size = 0.02\nextrude = { from = 0.0, to = 0.02 }\n");
  text.replace(text.find("type = \"shell\""), 14, "type = \"solid\" ");
  text.erase(text.find("thickness = 0.02\n"), 17);
  const Scene scene = parse_scene(text, "scene.toml");
  EXPECT_EQ(scene.mesh.annulus->element_size, 0.02);
  EXPECT_EQ(scene.reduce.method, reduce::Method::automatic);
  text.erase(text.find("element_size = 0.02\n"), 20);
  EXPECT_NE(error_of(text).find("element_size"), std::string::npos) << error_of(text);
}

TEST(SceneAccuracyError, NamesWhatItChoosesItself)
{
  const auto starts = [](const std::string& text, const std::string& with) {
    EXPECT_EQ(error_of(text).substr(0, with.size()), with);
  };
  starts(accurate("element_size = 0.01\n"),
         "scene.toml:6: mesh.element_size = 0.01: `accuracy` chooses it; take this key out");
  starts(accurate("", "[reduce]\nmethod = \"guyan\"\n"),
         "scene.toml:18: reduce.method = \"guyan\": Guyan's method cannot keep an accuracy");
  starts(accurate("", "[reduce]\nmodes = 7\n"),
         "scene.toml:18: reduce.modes = 7: `accuracy` chooses what is kept; take this key out");
  starts("accuracy = 1e-3\n" + accurate().substr(accurate().find('\n') + 1),
         "scene.toml:1: accuracy = 0.001: must say up to which frequency too");
}

TEST(SceneMesh, HoldsWhatAFileNeeds)
{
  const auto options = options_of(
      "file = \"a.geo\"\nlength_unit = \"mm\"\nelement_order = 2\n"
      "parameters = { n_holes = 24, size = 6.5 }\n"
      "groups = { disc = [\"surface_1\", \"surface_2\"], outer_edge = [\"curve_3\"] }\n"
      "coincident_nodes = \"merge\"\nmerge_tolerance = 1e-6\n"
      "rings = [{ name = \"track\", radius = 0.13, nodes = 60, z = 0.01 }]\n",
      "disc");
  EXPECT_EQ(options.file, "folder/a.geo");
  EXPECT_EQ(options.length_unit, 1e-3);
  EXPECT_EQ(options.element_order, 2);
  const std::vector<std::pair<std::string, double>> parameters{{"n_holes", 24.0}, {"size", 6.5}};
  EXPECT_EQ(options.parameters, parameters);
  ASSERT_EQ(options.groups.size(), 2u);
  EXPECT_EQ(options.groups[0].name, "disc");
  EXPECT_EQ(options.groups[0].entities, (std::vector<std::string>{"surface_1", "surface_2"}));
  EXPECT_EQ(options.coincident_nodes, mesh::Coincident::merge);
  EXPECT_EQ(options.merge_tolerance, 1e-6);
  EXPECT_EQ(options.rings.at(0).z, 0.01);
  const auto step = options_of("file = \"a.step\"\nelement_size = 0.01\n", "surface_1");
  EXPECT_EQ(step.element_size, 0.01);
}

TEST(SceneMeshError, NamesWhatAFileDoesNotTake)
{
  EXPECT_EQ(mesh_error("file = \"a.iges\"\n"),
            "scene.toml:2: mesh.file = \"a.iges\": must be a mesh file: .msh, .geo (Gmsh), "
            ".step, .stp (STEP), .unv (universal files), .med, .mmed (MED), .bdf, .nas, .dat "
            "(Nastran), .inp (Abaqus), .cdb (Ansys)");
  EXPECT_NE(mesh_error("file = \"a.vtu\"\n").find("meshio makes a .msh of a .vtu"),
            std::string::npos);
  EXPECT_NE(mesh_error("file = \"a.geo\"\ndoubled_elements = \"keep\"\n").find("is for decks"),
            std::string::npos);
  EXPECT_EQ(mesh_error("file = \"a.msh\"\nelement_order = 2\n"),
            "scene.toml:3: mesh.element_order = 2: a .msh file has its own order; take this key "
            "out");
  EXPECT_EQ(mesh_error("file = \"a.geo\"\nelement_size = 0.1\n"),
            "scene.toml:3: mesh.element_size = 0.1: is for .step files; a .geo has its own sizes");
  EXPECT_EQ(mesh_error("file = \"a.step\"\nelement_size = 0.1\nlength_unit = \"mm\"\n"),
            "scene.toml:4: mesh.length_unit = \"mm\": a .step file contains its unit");
  EXPECT_NE(mesh_error("file = \"a.step\"\n").find("element_size"), std::string::npos);
  EXPECT_EQ(mesh_error("file = \"a.geo\"\nparameters = { \"a-b\" = 1.0 }\n").substr(0, 13),
            "scene.toml:3:");
  EXPECT_EQ(mesh_error("file = \"a.geo\"\nlength_unit = \"yard\"\n"),
            "scene.toml:3: mesh.length_unit = \"yard\": must be one of \"m\", \"cm\", \"mm\", "
            "\"inch\"");
  EXPECT_NE(mesh_error("file = \"a.geo\"\ngroups = { disc = [] }\n").find("surface_1"),
            std::string::npos);
  EXPECT_NE(mesh_error("file = \"a.geo\"\ncoincident_nodes = \"glue\"\n").find("\"keep\""),
            std::string::npos);
}

}  // namespace
}  // namespace chladni::scene
