// Parts, joints and linings as the scene of an assembly gives them.
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene_text.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using squeal::AssemblyOptions;
using test::error_of;
using test::replaced;

const std::string assembled_brake = R"([[part]]
name = "disc"
body = "disc.body.h5"
[[part]]
name = "pad"
body = "pad.body.h5"
position = [0.1, 0.2, 0.3]
rotation_deg = [180.0, 0.0, 90.0]
[[part]]
name = "caliper"
body = "caliper.body.h5"
[[joint]]
between = ["ground", "pad.ears"]
type = "spring"
stiffness = { x = 2e7, rz = 3.0 }
damping = { y = 5.0 }
[[joint]]
between = ["pad.back", "caliper.finger"]
type = "rigid"
dofs = ["z", "x"]
span = 0.02
[[contact]]
face = "pad.lining"
height = 0.013
stiffness_per_area = 2e10
damping = 4.0
pressure = 1e6
[squeal]
model = "assembly"
disc = "disc"
rings = ["inner", "outer"]
thickness = 0.02
friction = 0.5
speeds = { from_rad_s = 3.0, to_rad_s = 63.0, count = 20 }
analyses = ["eigenvalues"]
)";

AssemblyOptions assembly_options_of(const std::string& text)
{
  return std::get<AssemblyOptions>(parse_scene(text, "scene.toml").squeal_model.value().model);
}

TEST(SceneAssembly, HasPartsJointsAndLinings)
{
  const AssemblyOptions options = assembly_options_of(assembled_brake);
  ASSERT_EQ(options.parts.size(), 3u);
  EXPECT_EQ(options.parts[1].body, "pad.body.h5");
  EXPECT_EQ(options.parts[1].position[2], 0.3);
  EXPECT_DOUBLE_EQ(options.parts[1].rotation[2], std::numbers::pi / 2.0);
  ASSERT_EQ(options.joints.size(), 2u);
  EXPECT_EQ(options.joints[0].ends[0].set, "ears");
  EXPECT_TRUE(options.joints[0].ends[1].is_ground());
  EXPECT_TRUE(options.joints[0].rigid.empty());
  EXPECT_EQ(options.joints[0].stiffness, (std::array<double, 6>{2e7, 0.0, 0.0, 0.0, 0.0, 3.0}));
  EXPECT_EQ(options.joints[0].damping[1], 5.0);
  EXPECT_EQ(options.joints[1].rigid, (std::vector{2, 0}));
  EXPECT_FALSE(options.joints[1].spares_drilling);
  EXPECT_TRUE(assembly_options_of(replaced(assembled_brake, "dofs = [\"z\", \"x\"]", ""))
                  .joints[1]
                  .spares_drilling);
  EXPECT_EQ(options.joints[1].span, 0.02);
  ASSERT_EQ(options.contacts.size(), 1u);
  EXPECT_TRUE(options.contacts[0].stiffness.per_area);
  EXPECT_FALSE(options.contacts[0].damping.per_area);
  EXPECT_EQ(options.contacts[0].preload.value, 1e6);
  EXPECT_EQ(options.rings.size(), 2u);
  EXPECT_TRUE(options.convection);
  EXPECT_FALSE(assembly_options_of(replaced(assembled_brake, "friction = 0.5",
                                            "friction = 0.5\nconvection = \"left out\""))
                   .convection);
}

struct AssemblyMistake {
  std::string old_part, new_part, said;
};

TEST(SceneAssembly, SaysWhichKeyIsWrong)
{
  const std::vector<AssemblyMistake> mistakes{
      {"face = \"pad.lining\"", "face = \"plate.lining\"",
       "scene.toml:23: contact.face = \"plate.lining\": no such part in the scene"},
      {"face = \"pad.lining\"", "face = \"lining\"", "must name nodes as \"PART.SET\""},
      {"face = \"pad.lining\"", "face = \"disc.track\"", "is part of \"disc\", which turns"},
      {"name = \"caliper\"", "name = \"pad\"", "is the name of another part too"},
      {"\"caliper.finger\"", "\"pad.ears\"", "must name two parts, or one and the ground"},
      {"disc = \"disc\"", "disc = \"rotor\"", "no such part in the scene"},
      {"pressure = 1e6", "pressure = 1e6\npreload = 3.0", "preload"},
      {"{ x = 2e7, rz = 3.0 }", "{ }", "must name a direction"},
      {"body = \"disc.body.h5\"", "body = \"disc.body.h5\"\nposition = [1.0, 0.0, 0.0]",
       "is that of the disc, which turns about the z axis of its own mesh"},
      {"[\"eigenvalues\"]", "[\"eigenvalues\", \"limit-cycle-branch\"]",
       "is not available for an assembly, whose contact is linear"},
      {"analyses = [",
       "transient = { speed_rad_s = 3.0, duration_s = 1.0, initial_pad_displacement = 1e-6 "
       "}\nanalyses = [",
       "is not available for an assembly, whose contact is linear; take it out"},
      {"[\"inner\", \"outer\"]", "[\"inner\", \"inner\"]", "names \"inner\" twice"},
      {"model = \"assembly\"", "", "belongs to an assembly"},
      {"span = 0.02", "span = 0.02\nstiffness = { x = 1.0 }", "joint[2].stiffness"},
  };
  for (const auto& [old_part, new_part, said] : mistakes) {
    const std::string error = error_of(replaced(assembled_brake, old_part, new_part));
    EXPECT_NE(error.find(said), std::string::npos) << new_part << ": " << error;
  }
}

TEST(SceneAssembly, MakesResultsStaleByItsTables)
{
  for (const auto& [old_part, new_part] :
       {std::pair{"position = [0.1, ", "position = [0.7, "},
        std::pair{"height = 0.013", "height = 0.02"}, std::pair{"x = 2e7", "x = 1e7"}}) {
    const std::string other = replaced(assembled_brake, old_part, new_part);
    EXPECT_EQ(changed_keys(assembled_brake, other, Step::squeal).size(), 1u) << new_part;
    EXPECT_EQ(changed_keys(assembled_brake, other, Step::reduction).size(), 0u) << new_part;
  }
}

}  // namespace
}  // namespace chladni::scene
