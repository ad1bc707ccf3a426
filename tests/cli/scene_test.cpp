#include "cli/scene/scene.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "scene_texts.hpp"

namespace chladni::cli {
namespace {

using testing::disc;
using testing::replaced;

TEST(Scene, HoldsTheMeshAndItsSections)
{
  const Scene scene = parse_scene(disc, "folder/scene.toml");
  ASSERT_TRUE(scene.mesh.annulus);
  EXPECT_EQ(scene.name, "disc");
  EXPECT_EQ(scene.title, "Disc");
  EXPECT_EQ(scene.text, disc);
  EXPECT_EQ(scene.mesh.annulus->inner_radius, 0.025);
  EXPECT_EQ(scene.mesh.annulus->outer_radius, 0.162);
  EXPECT_EQ(scene.mesh.annulus->element_size, 0.0078);
  EXPECT_EQ(scene.mesh.annulus->element_order, 3);
  ASSERT_EQ(scene.mesh.annulus->rings.size(), 1u);
  EXPECT_EQ(scene.mesh.annulus->rings[0].radius, 0.13);
  EXPECT_EQ(scene.mesh.annulus->rings[0].nodes, 60);
  ASSERT_EQ(scene.sections.size(), 1u);
  EXPECT_EQ(scene.sections[0].material.young, 9e10);
  EXPECT_EQ(scene.sections[0].material.poisson, 0.3);
  EXPECT_EQ(scene.sections[0].material.density, 6300.0);
  EXPECT_EQ(scene.sections[0].thickness, 0.02);
  ASSERT_EQ(scene.couplings.size(), 1u);
  EXPECT_EQ(scene.couplings[0].group, "inner_edge");
}

TEST(Scene, HoldsTheReductionAndTheBody)
{
  const Scene scene = parse_scene(disc, "scene.toml");
  EXPECT_EQ(scene.interface_nodes, (std::vector<std::string>{"track", "hub"}));
  EXPECT_EQ(scene.pictures, PictureChoice::vertices);
  EXPECT_EQ(scene.reduce.modes, 100);
  EXPECT_FALSE(scene.reduce.cutoff_Hz);
  EXPECT_EQ(scene.body.keep.count, 40);
  ASSERT_EQ(scene.body.interface_modes.size(), 1u);
  EXPECT_EQ(scene.body.interface_modes[0].components, std::vector<int>{2});
  EXPECT_FALSE(scene.body.interface_modes[0].omega0);
  EXPECT_EQ(scene.body.damping.type, mbs_export::Damping::Type::none);
}

TEST(Scene, HoldsTheToleranceOfTheBody)
{
  const Scene scene = parse_scene(
      replaced(disc, "{ modes = 40 }", "{ tolerance = 1e-3, up_to_Hz = 8e3 }"), "scene.toml");
  ASSERT_TRUE(scene.body.keep.tolerance);
  EXPECT_EQ(scene.body.keep.tolerance->error, 1e-3);
  EXPECT_EQ(scene.body.keep.tolerance->up_to_Hz, 8e3);
  EXPECT_FALSE(scene.body.keep.up_to_Hz || scene.body.keep.count || scene.body.keep.list);
}

TEST(Scene, TakesValuesInsteadOfDefaults)
{
  std::string text = replaced(disc, "title = \"Disc\"", "name = \"rotor_1\"");
  text = replaced(text, "modes = 100", "cutoff_Hz = 16e3\npictures = \"none\"\nsylvester = true");
  text = replaced(text, "{ modes = 40 }", "{ list = [7, 8] }");
  text = replaced(text, "{ type = \"none\" }", "{ type = \"modal\", ratio = 0.001 }");
  text = replaced(text, "\"nodal-diameters 3\"", "[1, 2]");
  text = replaced(text, "7e-8 }",
                  "7e-8, steps_per_period = 80, "
                  "integrator = \"dormand-prince\", growth_error_1_s = 1e-4 }");
  text = replaced(text, "contact = \"bilateral\"\n", "");
  const Scene scene = parse_scene(text, "scene.toml");
  EXPECT_EQ(scene.name, "rotor_1");
  EXPECT_EQ(scene.title, "rotor_1");
  EXPECT_EQ(scene.reduce.cutoff_Hz, 16e3);
  EXPECT_FALSE(scene.reduce.modes);
  EXPECT_EQ(scene.pictures, PictureChoice::none);
  EXPECT_TRUE(scene.sylvester);
  EXPECT_EQ(scene.body.keep.list, (std::vector<int>{7, 8}));
  EXPECT_EQ(scene.body.damping.ratios, std::vector<double>{0.001});
  EXPECT_EQ(scene.squeal->modes.list, (std::vector<int>{1, 2}));
  EXPECT_EQ(scene.squeal->transient->steps_per_period, 80);
  EXPECT_EQ(scene.squeal->transient->integrator, squeal::IntegratorKind::dormand_prince);
  EXPECT_EQ(scene.squeal->transient->growth_error, 1e-4);
  EXPECT_EQ(scene.squeal->contact, squeal::ContactLaw::unilateral);
}

TEST(Scene, NeedsNeitherBodyNorSqueal)
{
  const Scene scene = parse_scene(disc.substr(0, disc.find("[body]")), "scene.toml");
  EXPECT_TRUE(scene.body.fixed.empty());
  EXPECT_FALSE(scene.body.keep.count);
  EXPECT_FALSE(scene.squeal);
}

TEST(Scene, FindsAMeshFileInItsOwnFolder)
{
  const std::size_t begin = disc.find("generator");
  const std::string generator = disc.substr(begin, disc.find("rings") - begin);
  const std::string text = replaced(disc, generator, "file = \"../mesh/disc.msh\"\n");
  const Scene scene = parse_scene(text, "cases/a/scene.toml");
  EXPECT_EQ(scene.mesh.file, "cases/mesh/disc.msh");
  EXPECT_FALSE(scene.mesh.annulus);
  EXPECT_EQ(scene.mesh.rings.size(), 1u);
}

TEST(Scene, OfTheExampleIsReadable)
{
  const Scene scene = read_scene(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml");
  ASSERT_TRUE(scene.squeal && scene.squeal->transient && scene.squeal->growth);
  // Written with nine digits in the file.
  EXPECT_NEAR(scene.squeal->transient->speed, 6.0 * std::numbers::pi, 1e-7);
  EXPECT_NEAR(scene.squeal->growth->speeds.front(), 3.8 * std::numbers::pi, 1e-7);
  EXPECT_EQ(scene.squeal->contact, squeal::ContactLaw::bilateral);
}

TEST(Scene, ReadsATolerancePromisedUpToAFrequency)
{
  const Scene scene =
      parse_scene(replaced(disc, "modes = 100", "tolerance = 1e-3\nup_to_Hz = 8e3"), "scene.toml");
  ASSERT_TRUE(scene.reduce.tolerance.has_value());
  EXPECT_EQ(scene.reduce.tolerance->tolerance, 1e-3);
  EXPECT_EQ(scene.reduce.tolerance->up_to_Hz, 8e3);
}

}  // namespace
}  // namespace chladni::cli
