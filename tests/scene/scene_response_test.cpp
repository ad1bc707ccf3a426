// What `chladni response` reads of a scene.
#include <gtest/gtest.h>

#include "scene/scene.hpp"
#include "scene/scene_text.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::error_of;
using test::replaced;

const std::string of_fe_model = R"([mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_size = 0.03
rings = [{ name = "track", radius = 0.13, nodes = 12 }]
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[response]
of = "fe"
loads = [{ at = "outer_edge", dofs = ["z"] }, { at = "track", dofs = ["x", "ry"], near = [0.1, 0.0, 0.0] }]
outputs = [{ at = "track", dofs = ["z"] }]
from_Hz = 10.0
to_Hz = 1000.0
count = 3
)";

TEST(SceneOfResponses, ReadsPlacesAndFrequencies)
{
  const Scene scene = parse_scene(of_fe_model, "scene.toml");
  ASSERT_TRUE(scene.response);
  EXPECT_EQ(scene.response->model, mbs_export::ResponseModel::fe);
  EXPECT_EQ(scene.response->quantity, mbs_export::ResponseQuantity::receptance);
  ASSERT_EQ(scene.response->loads.size(), 2U);
  EXPECT_EQ(scene.response->loads[1].components, (std::vector{0, 4}));
  EXPECT_EQ(scene.response->loads[1].near->at(0), 0.1);
  EXPECT_FALSE(scene.response->outputs[0].near);
  EXPECT_EQ(scene.response->range.count, 3);
  EXPECT_EQ(scene.response->range.spacing, mbs_export::Spacing::linear);
  EXPECT_EQ(scene.response->loss_factor, 0.0);
  const std::string damped = std::string(of_fe_model) + "loss_factor = 0.02\n";
  EXPECT_EQ(parse_scene(damped, "scene.toml").response->loss_factor, 0.02);
}

TEST(SceneOfResponses, NeedsAReductionForABody)
{
  EXPECT_EQ(error_of(of_fe_model), "no error");
  const std::string of_body = replaced(of_fe_model, "\"fe\"", "\"body\"");
  EXPECT_NE(error_of(of_body).find("interface is missing"), std::string::npos);
  try {
    parse_scene(of_body, "scene.toml", Purpose::fe_model);
    FAIL() << "there is no body";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("scene.toml:17: response.of = \"body\""),
              std::string::npos)
        << error.what();
  }
}

TEST(SceneOfResponses, AsksForPlacesThatThereAre)
{
  EXPECT_NE(
      error_of(replaced(of_fe_model, "outputs = [{ at = \"track\"", "outputs = [{ at = \"trakc\""))
          .find("response.outputs.at = \"trakc\": no such group, ring or coupling"),
      std::string::npos);
  EXPECT_NE(error_of(replaced(of_fe_model, "[0.1, 0.0, 0.0]", "[0.1, 0.0]")).find("three numbers"),
            std::string::npos);
}

TEST(SceneOfResponses, LeavesReductionAndBodyAsTheyAre)
{
  const std::string other = replaced(of_fe_model, "to_Hz = 1000.0", "to_Hz = 900.0");
  EXPECT_TRUE(changed_keys(of_fe_model, other, Step::reduction).empty());
  EXPECT_TRUE(changed_keys(of_fe_model, other, Step::body).empty());
}

}  // namespace
}  // namespace chladni::scene
