#include <gtest/gtest.h>

#include "scene_texts.hpp"

namespace chladni::cli {
namespace {

using testing::beam;
using testing::disc;
using testing::error_of;
using testing::replaced;
using testing::with_points;

TEST(Scene, HoldsABeam)
{
  const Scene scene = parse_scene(beam, "beam.toml");
  ASSERT_TRUE(scene.mesh.beam);
  EXPECT_FALSE(scene.mesh.annulus);
  EXPECT_EQ(scene.mesh.beam->end, (std::array{3.0, 0.0, 4.0}));
  EXPECT_EQ(scene.mesh.beam->elements, 10);
  ASSERT_EQ(scene.mesh.beam->points.size(), 1u);
  EXPECT_EQ(scene.mesh.beam->points[0].distance, 2.5);
  EXPECT_EQ(scene.mesh.line_groups, std::vector<std::string>{"beam"});
  EXPECT_EQ(scene.components, (std::vector<int>{2, 4}));
  ASSERT_EQ(scene.beams.size(), 1u);
  EXPECT_EQ(scene.beams[0].theory, plate::BeamTheory::bernoulli_euler);
  EXPECT_FALSE(scene.beams[0].has_rotary_inertia);
  EXPECT_EQ(scene.beams[0].orientation, (std::array{1.0, 0.0, 0.0}));
  EXPECT_EQ(scene.beams[0].I_z, 2e-6);
  EXPECT_EQ(scene.resultants, std::vector<std::string>{"beam"});
  EXPECT_TRUE(scene.sections.empty());
}

TEST(Scene, TakesATimoshenkoBeamInSpaceUnlessTold)
{
  std::string text = replaced(beam, "theory = \"bernoulli-euler\"\nrotary_inertia = \"none\"\n",
                              "shear_factor_y = 0.85\n");
  text = replaced(text, "[model]\ndofs = [\"ry\", \"z\"]\n", "");
  const Scene scene = parse_scene(text, "beam.toml");
  EXPECT_EQ(scene.components.size(), 6u);
  EXPECT_EQ(scene.beams[0].theory, plate::BeamTheory::timoshenko);
  EXPECT_TRUE(scene.beams[0].has_rotary_inertia);
  EXPECT_EQ(scene.beams[0].shear_factor_y, 0.85);
  EXPECT_EQ(scene.beams[0].shear_factor_z, 5.0 / 6.0);
}

TEST(SceneError, NamesWhatABeamCannotBe)
{
  const auto expect = [](const std::string& good, const std::string& bad,
                         const std::string& message) {
    EXPECT_EQ(error_of(replaced(beam, good, bad)), message);
  };
  expect("end = [3.0, 0.0, 4.0]", "end = [3.0, 0.0]",
         "scene.toml:5: mesh.end = [ 3.0, 0.0 ]: must be three numbers [x, y, z]");
  expect("end = [3.0, 0.0, 4.0]", "end = [0.0, 0.0, 0.0]",
         "scene.toml:5: mesh.end = [ 0.0, 0.0, 0.0 ]: is the start of the beam too");
  expect("elements = 10", "elements = 0",
         "scene.toml:6: mesh.elements = 0: must be >= 1 and <= 1000000");
  expect("elements = 10\n", "", "scene.toml:2: mesh: give exactly one of elements, element_size");
  expect("distance = 2.5", "distance = 5.5",
         "scene.toml:7: mesh.points.distance = 5.5: must be >= 0 and <= 5 (m, along the beam)");
  expect("name = \"B\"", "name = \"end\"",
         "scene.toml:7: mesh.points.name = \"end\": is the name of another point or group of the "
         "mesh");
  expect("[\"ry\", \"z\"]", "[\"w\"]",
         "scene.toml:9: model.dofs[1] = \"w\": must be one of \"x\", \"y\", \"z\", \"rx\", "
         "\"ry\", \"rz\"");
  expect("type = \"beam\"", "type = \"shell\"",
         "scene.toml:16: section.type = \"shell\": the generator \"beam\" makes lines; use "
         "\"beam\"");
  expect("theory = \"bernoulli-euler\"", "theory = \"euler\"",
         "scene.toml:18: section.theory = \"euler\": must be one of \"timoshenko\", "
         "\"bernoulli-euler\"");
  expect("rotary_inertia = \"none\"", "rotary_inertia = \"no\"",
         "scene.toml:19: section.rotary_inertia = \"no\": must be one of \"full\", \"none\"");
  expect("rotary_inertia = \"none\"", "shear_factor_z = 0.8",
         "scene.toml:19: section.shear_factor_z = 0.8: a beam of Bernoulli and Euler is rigid in "
         "shear; take this key out");
  expect("orientation = [1.0, 0.0, 0.0]\n", "",
         "scene.toml:21: section.I_y = 1e-06: differs from the z axis, so that the section needs "
         "`orientation`, a vector [x, y, z] towards its z axis");
  expect("orientation = [1.0, 0.0, 0.0]", "orientation = [0.0, 0.0, 0.0]",
         "scene.toml:20: section.orientation = [ 0.0, 0.0, 0.0 ]: must not be zero; it points "
         "towards the z axis of the section");
  expect("I_y = 1e-6", "I_y = 0.0", "scene.toml:22: section.I_y = 0: must be > 0 (m^4)");
  expect("nodes = [\"start\", \"B\"]", "nodes = [\"A\"]",
         "scene.toml:26: interface.nodes[1] = \"A\": no such point or coupling in the scene; "
         "there are: \"start\", \"end\", \"B\"");
  expect("resultants = [\"beam\"]", "resultants = [\"rim\"]",
         "scene.toml:30: reduce.resultants[1] = \"rim\": no such group of beams in the scene; "
         "there are: \"beam\"");
  EXPECT_EQ(error_of(replaced(disc, "type = \"shell\"", "type = \"beam\"")),
            "scene.toml:15: section.type = \"beam\": this generator makes surfaces; use \"shell\"");
}

TEST(Scene, HoldsLumpedMassesSpringsAndDampers)
{
  const Scene scene = parse_scene(with_points, "beam.toml");
  ASSERT_EQ(scene.masses.size(), 1u);
  EXPECT_EQ(scene.masses[0].at, "end");
  EXPECT_EQ(scene.masses[0].mass, 2.5);
  EXPECT_EQ(scene.masses[0].inertia, (std::array{1.0, 2.0, 2.5, 0.0, 0.0, 0.0}));
  EXPECT_EQ(scene.masses[0].offset, (std::array{0.0, 0.0, 0.1}));
  ASSERT_EQ(scene.springs.size(), 2u);
  EXPECT_EQ(scene.springs[0].stiffness, (std::array{0.0, 0.0, 1e6, 0.0, 20.0, 0.0}));
  EXPECT_FALSE(scene.springs[0].to);
  EXPECT_EQ(scene.springs[1].to, "end");
  EXPECT_EQ(scene.springs[1].damping[0], 35.0);
}

TEST(Scene, KeepsTheDampersOfTheModelUnlessTheBodySaysOtherwise)
{
  using Type = mbs_export::Damping::Type;
  EXPECT_EQ(parse_scene(with_points, "beam.toml").body.damping.type, Type::matrix);
  EXPECT_EQ(parse_scene(beam, "beam.toml").body.damping.type, Type::none);
  const std::string said =
      replaced(with_points, "[body]\n", "[body]\ndamping = { type = \"none\" }\n");
  EXPECT_EQ(parse_scene(said, "beam.toml").body.damping.type, Type::none);
}

TEST(SceneError, NamesWhatAMassOrSpringCannotBe)
{
  const auto expect = [](const std::string& good, const std::string& bad,
                         const std::string& message) {
    EXPECT_EQ(error_of(replaced(with_points, good, bad)), message);
  };
  expect("at = \"end\"", "at = \"tip\"",
         "scene.toml:34: mass.at = \"tip\": no such group or coupling in the scene; there are: "
         "\"beam\", \"start\", \"end\", \"B\"");
  expect("mass = 2.5", "mass = 0.0", "scene.toml:35: mass.mass = 0: must be > 0 (kg)");
  expect("[1.0, 2.0, 2.5]", "[1.0, 2.0]",
         "scene.toml:36: mass.inertia = [ 1.0, 2.0 ]: must be three moments [xx, yy, zz] or six "
         "[xx, yy, zz, xy, xz, yz]");
  for (const char* inertia :
       {"[1.0, 2.0, 3.5]", "[-1.0, 2.0, 2.5]", "[1.0, 2.0, 2.5, 2.0, 0, 0]"}) {
    EXPECT_NE(error_of(replaced(with_points, "[1.0, 2.0, 2.5]", inertia))
                  .find("no rigid body has these moments"),
              std::string::npos)
        << inertia;
  }
  expect("stiffness = { z = 1e6, ry = 20.0 }", "",
         "scene.toml:39: spring[1].at = \"B\": the spring needs `stiffness` or `damping`, like { z "
         "= 1e6 }");
  expect("{ z = 1e6, ry = 20.0 }", "{ z = -1e6 }",
         "scene.toml:40: spring[1].stiffness.z = -1000000: must be >= 0 (N/m, N m/rad)");
  expect("{ z = 1e6, ry = 20.0 }", "{ w = 1e6 }",
         "scene.toml:40: spring[1].stiffness.w is not a key here; allowed: rx, ry, "
         "rz, x, y, z");
  expect("to = \"end\"", "to = \"start\"",
         "scene.toml:43: spring[2].to = \"start\": is the place where the spring begins");
}

}  // namespace
}  // namespace chladni::cli
