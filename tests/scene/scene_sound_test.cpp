// What `chladni sound` reads of a scene.
#include <gtest/gtest.h>

#include "scene/scene.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::error_of;

const std::string sounding_disc = R"([mesh]
generator = "annulus"
inner_radius = 0.025
outer_radius = 0.162
element_size = 0.03
rings = [{ name = "track", radius = 0.13, nodes = 24 }]
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
group = "disc"
type = "shell"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "inner_edge"
[interface]
nodes = ["track", "hub"]
[reduce]
method = "craig-bampton"
modes = 20
[body]
fixed = ["hub"]
[squeal]
ring = "track"
thickness = 0.02
speeds = { from_rad_s = 3.0, to_rad_s = 60.0, count = 5 }
friction = 0.6
pads = [{ angle_deg = 0.0, stiffness = 6e6, damping = 0.0, preload = 2000.0 }]
analyses = ["eigenvalues"]
)";

const std::string microphones =
    "[sound]\nmicrophones = [{ name = \"a\", position = [0.5, 0.0, 0.5] }]\n";

void expect_words(const std::string& error, const std::vector<std::string>& words)
{
  EXPECT_NE(error, "no error");
  for (const std::string& word : words)
    EXPECT_NE(error.find(word), std::string::npos) << word << " in " << error;
}

TEST(SoundOfAScene, IsAbsentWithoutItsTable)
{
  EXPECT_FALSE(parse_scene(sounding_disc, "scene.toml").sound);
  EXPECT_FALSE(parse_scene(sounding_disc, "scene.toml").radiation);
  EXPECT_TRUE(parse_scene(sounding_disc + "radiation = true\n", "scene.toml").radiation);
}

TEST(SoundOfAScene, TakesTheOutlineOfAGeneratedDisc)
{
  const auto options = *parse_scene(sounding_disc + microphones, "scene.toml").sound;
  ASSERT_EQ(options.lines.size(), 1U);
  EXPECT_EQ(options.lines[0].from, Eigen::Vector2d(0.025, 0.0));
  EXPECT_EQ(options.lines[0].to, Eigen::Vector2d(0.162, 0.0));
  EXPECT_EQ(options.lines[0].thickness, 0.02);
  EXPECT_EQ(options.hub, sound::Hub::closed);
  ASSERT_EQ(options.microphones.size(), 1U);
  EXPECT_EQ(options.microphones[0].x, Eigen::Vector3d(0.5, 0.0, 0.5));
}

TEST(SoundOfAScene, ReadsEveryKey)
{
  const auto options = *parse_scene(sounding_disc + microphones + R"(hub = "open"
outline = [{ from = [0.02, 0.0], to = [0.17, 0.01], thickness = 0.03 }]
holes = [{ circle_radius = 0.1, radius = 0.01, count = 4, angle_deg = 45.0 }]
medium = { density = 1.1, speed_of_sound = 340.0 }
method = "tetrahedra"
order = 3
element_size = 0.01
edge_size = 0.005
inner_radius = 0.3
layer_thickness = 0.2
layer_strength = 7.0
cycle = "direct"
harmonics = 2
speeds_rad_s = [10.0, 20.0]
wav = { microphone = "a", rate_Hz = 48000, duration_s = 2.0 }
)",
                                    "scene.toml")
                            .sound;
  EXPECT_EQ(options.hub, sound::Hub::open);
  EXPECT_EQ(options.lines[0].to, Eigen::Vector2d(0.17, 0.01));
  EXPECT_EQ(options.holes[0].count, 4);
  EXPECT_NEAR(options.holes[0].angle, 0.785398, 1e-6);
  EXPECT_EQ(options.air.medium.density, 1.1);
  EXPECT_EQ(options.air.medium.speed_of_sound, 340.0);
  EXPECT_EQ(options.air.method, sound::Method::tetrahedra);
  EXPECT_EQ(options.air.order, 3);
  EXPECT_EQ(options.air.element_size, 0.01);
  EXPECT_EQ(options.air.edge_size, 0.005);
  EXPECT_EQ(options.air.inner_radius, 0.3);
  EXPECT_EQ(options.air.layer_thickness, 0.2);
  EXPECT_EQ(options.air.layer_strength, 7.0);
  EXPECT_EQ(options.cycle, sound::CycleChoice::direct);
  EXPECT_EQ(options.harmonics, 2);
  EXPECT_EQ(options.speeds, (std::vector<double>{10.0, 20.0}));
  ASSERT_TRUE(options.wav);
  EXPECT_EQ(options.wav->rate_Hz, 48000);
}

TEST(SoundOfAScene, NamesWhatIsWrong)
{
  const auto with = [&](const std::string& key) {
    return error_of(sounding_disc + microphones + key);
  };
  expect_words(with("methd = \"auto\"\n"), {"methd"});
  expect_words(with("method = \"boundary\"\n"), {"sound.method", "boundary", "fourier"});
  expect_words(with("element_size = -1.0\n"), {"sound.element_size", "-1"});
  expect_words(with("harmonics = 9\n"), {"sound.harmonics", "9", "8"});
  expect_words(with("order = 1\n"), {"sound.order = 1", ">= 2 and <= 8"});
  expect_words(with("speeds_rad_s = [3.0, 0.0]\n"), {"sound.speeds_rad_s[2] = 0", "> 0"});
  expect_words(with("medium = { density = 0.0, speed_of_sound = 340.0 }\n"), {"density", "> 0"});
  expect_words(with("wav = { microphone = \"a\", rate_Hz = 48000, duration_s = 0.0 }\n"),
               {"sound.wav.duration_s = 0", ">= 0.1 and <= 600"});
  expect_words(with("holes = [{ circle_radius = 0.1, radius = 0.01, count = 0 }]\n"),
               {"sound.holes.count = 0", ">= 1"});
  expect_words(with("outline = [{ from = [0.1, 0.0], to = [0.1, 0.0], thickness = 0.02 }]\n"),
               {"outline", "to", "must differ from"});
  expect_words(with("outline = []\n"), {"outline", "at least one piece"});
  expect_words(with("outline = [{ from = [-0.1, 0.0], to = [0.1, 0.0], thickness = 0.02 }]\n"),
               {"outline", "from", "r >= 0"});
  expect_words(with("wav = { microphone = \"b\", rate_Hz = 48000, duration_s = 2.0 }\n"),
               {"microphone", "\"b\"", "\"a\""});
  expect_words(with("wav = { microphone = \"a\", rate_Hz = 200000, duration_s = 2.0 }\n"),
               {"sound.wav.rate_Hz", "200000", ">= 8000 and <= 192000 (Hz)"});
  expect_words(
      error_of(sounding_disc + "[sound]\nmicrophones = [{ name = \"a\", position = [0.5] }]\n"),
      {"position"});
  expect_words(
      error_of(sounding_disc + "[sound]\nmicrophones = [{ name = \"a\", position = [1, 0, 0] }, "
                               "{ name = \"a\", position = [2, 0, 0] }]\n"),
      {"name", "\"a\"", "another microphone"});
}

TEST(SoundOfAScene, NeedsTheSquealAndAnOutline)
{
  const std::string silent = sounding_disc.substr(0, sounding_disc.find("[squeal]"));
  expect_words(error_of(silent + microphones), {"sound", "[squeal]"});
  std::string tapered = sounding_disc + microphones;
  const std::string thickness = "thickness = 0.02\n[[coupling]]";
  tapered.replace(tapered.find(thickness), thickness.size(),
                  "thickness = { over = \"radius\", at = [0.0, 0.2], values = [0.02, 0.03] }\n"
                  "[[coupling]]");
  expect_words(error_of(tapered), {"outline"});
}

}  // namespace
}  // namespace chladni::scene
