#include "scene/scene_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/error.hpp"

namespace chladni::scene {
namespace {

const std::string text = R"(title = "Größe 3"  # 4
[squeal]
model = "oscillator"
speeds = { from_rad_s = 1.0, to_rad_s = 2e1, count = 4 }
friction = { kinetic = 0.5 } # "é" 0.6
oscillator.names = ["äö", { mass = +1_000.5 }]
pads = [{ stiffness = 6e6, preload = 2000 },
        { stiffness = 5e6 }]
[mesh]
element_size = 0.02)";

std::string text_at(const NumberPlace& place)
{
  return text.substr(place.from, place.to - place.from);
}

Scene scene_of(const std::string& all)
{
  Scene scene;
  scene.text = all;
  scene.path = "scene.toml";
  return scene;
}

TEST(SceneNumbers, AreFoundWhereTheyStand)
{
  std::vector<std::string> keys, numbers;
  for (const NumberPlace& place : number_places(text)) {
    keys.push_back(place.key);
    numbers.push_back(text_at(place));
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"squeal.speeds.from_rad_s", "squeal.speeds.to_rad_s",
                                            "squeal.speeds.count", "squeal.friction.kinetic",
                                            "squeal.oscillator.names[2].mass",
                                            "squeal.pads[1].stiffness", "squeal.pads[1].preload",
                                            "squeal.pads[2].stiffness", "mesh.element_size"}));
  EXPECT_EQ(numbers, (std::vector<std::string>{"1.0", "2e1", "4", "0.5", "+1_000.5", "6e6", "2000",
                                               "5e6", "0.02"}));
}

TEST(SceneNumbers, OfAKeyWithoutAPlaceAreThoseOfAllTables)
{
  const Scene scene = scene_of(text);
  EXPECT_EQ(places_of_squeal_key(scene, "squeal.pads.stiffness").size(), 2u);
  EXPECT_EQ(places_of_squeal_key(scene, "squeal.pads.preload").size(), 1u);
  const auto second = places_of_squeal_key(scene, "squeal.pads[2].stiffness");
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(text_at(second.front()), "5e6");
}

TEST(SceneNumbers, AreReplacedAndNothingElse)
{
  const Scene scene = scene_of(text);
  const std::vector<std::vector<NumberPlace>> places = {
      places_of_squeal_key(scene, "squeal.pads.stiffness"),
      places_of_squeal_key(scene, "squeal.friction.kinetic")};
  std::string expected = text;
  for (const auto& [was, is] :
       {std::pair{"6e6", "7000000.5"}, {"5e6", "7000000.5"}, {"0.5 }", "0.1 }"}})
    expected.replace(expected.find(was), std::string(was).size(), is);
  EXPECT_EQ(with_numbers(text, places, std::vector{7000000.5, 0.1}), expected);
}

/// What is said of a key that cannot vary.
std::string refusal(const std::string& key)
{
  try {
    places_of_squeal_key(scene_of(text), key);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SceneNumbers, ThatAreNotThereAreRefusedWithThoseThatAre)
{
  EXPECT_EQ(refusal("squeal.pads.stifness"),
            "scene.toml: squeal.pads.stifness is not a number in the scene, and only keys with a "
            "value there can vary; did you mean squeal.pads.stiffness?");
  EXPECT_NE(refusal("squeal.model").find("there are: \"squeal.speeds.from_rad_s\""),
            std::string::npos);
  EXPECT_NE(refusal("squeal.pads[3].stiffness"), "");
}

TEST(SceneNumbers, OfTheBodyAreRefused)
{
  EXPECT_EQ(refusal("mesh.element_size"),
            "scene.toml:10: mesh.element_size = 0.02: only keys of [squeal] can vary: other "
            "keys change the body, which is made before the sweep");
}

}  // namespace
}  // namespace chladni::scene
