#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.hpp"
#include "tests/common/files/scratch_folder.hpp"
#include "tests/scene/scene_texts.hpp"

namespace chladni::scene {
namespace {

using test::replaced;

/// A scene that names a group in each table that can name one.
const std::string brake_of_file = R"([mesh]
file = "disc.step"
element_size = 0.01
[material.iron]
young = 9e10
poisson = 0.3
density = 6300.0
[[section]]
type = "shell"
group = "surface_1"
material = "iron"
thickness = 0.02
[[coupling]]
type = "rigid"
name = "hub"
group = "curve_1"
[[coupling]]
type = "link"
group = "curve_2"
to = "curve_3"
[[mass]]
at = "curve_4"
mass = 1.0
[[spring]]
at = "hub"
to = "curve_5"
stiffness = { z = 1e6 }
[[support]]
group = "hub"
type = "clamped"
[[load]]
type = "force"
group = "curve_6"
force = [0.0, 0.0, 1.0]
[static]
report = ["hub", "curve_7"]
[interface]
nodes = ["hub", "curve_8"]
[reduce]
method = "guyan"
)";

const std::vector<std::string> groups{"surface_1", "curve_1", "curve_2", "curve_3", "curve_4",
                                      "curve_5",   "curve_6", "curve_7", "curve_8"};

/// What is said of the scene with one name in the text replaced.
std::string said_of(const std::string& text)
{
  const Scene scene = parse_scene(text, "scene.toml");  // as long as the file was not read
  try {
    check_groups(scene, groups);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(FileGroups, ThatExistAreTaken)
{
  EXPECT_EQ(said_of(brake_of_file), "no error");
}

TEST(FileGroups, ThatDoNotExistAreRefusedWithLineKeyAndTheNearestName)
{
  const std::vector<std::pair<std::string, std::string>> places{
      {"surface_1", "scene.toml:10: section.group = \"surfce_1\""},
      {"curve_1", "scene.toml:16: coupling[1].group = \"curv_1\""},
      {"curve_2", "scene.toml:19: coupling[2].group = \"curv_2\""},
      {"curve_3", "scene.toml:20: coupling[2].to = \"curv_3\""},
      {"curve_4", "scene.toml:22: mass.at = \"curv_4\""},
      {"curve_5", "scene.toml:26: spring.to = \"curv_5\""},
      {"curve_6", "scene.toml:33: load.group = \"curv_6\""},
      {"curve_7", "scene.toml:36: static.report[2] = \"curv_7\""},
      {"curve_8", "scene.toml:38: interface.nodes[2] = \"curv_8\""}};
  for (const auto& [name, place] : places) {
    const std::string slip = replaced(name, name.starts_with('s') ? "a" : "e", "");
    const std::string said =
        said_of(replaced(brake_of_file, "\"" + name + "\"", "\"" + slip + "\""));
    EXPECT_NE(said.find(place), std::string::npos) << said;
    EXPECT_NE(said.find("did you mean \"" + name + "\"? there are: "), std::string::npos) << said;
  }
}

TEST(FileGroups, OfAnotherNameThanTheCouplings)
{
  const std::string said = said_of(replaced(brake_of_file, "name = \"hub\"", "name = \"curve_1\""));
  EXPECT_NE(said.find("scene.toml:15: coupling[1].name = \"curve_1\": is the name of another"),
            std::string::npos)
      << said;
}

TEST(FileGroups, OfAMeshWithMatricesAreThoseBesideTheScene)
{
  const files::test::ScratchFolder folder;
  for (const char* name : {"disc.sti", "disc.mas"}) std::ofstream(folder.file(name)) << "1 1 1\n";
  const auto said = [&](const std::string& group) {
    const Scene scene = parse_scene(R"([mesh]
file = "disc.inp"
length_unit = "mm"
matrices = { stiffness = "disc.sti", mass = "disc.mas" }
[[coupling]]
type = "rigid"
name = "hub"
group = ")" + group + R"("
[interface]
nodes = ["hub"]
[reduce]
method = "guyan"
)",
                                    folder.file("scene.toml"));
    return files::test::error_of([&] { check_groups(scene, {"BORE"}); });
  };
  EXPECT_EQ(said("BORE"), "");
  EXPECT_NE(said("BOREHOLE").find("there are: "), std::string::npos) << said("BOREHOLE");
}

TEST(FileGroups, AreListedUpToThirty)
{
  std::vector<std::string> many = groups;
  for (int i = 9; i <= 40; ++i) many.push_back("curve_" + std::to_string(i));
  const Scene scene = parse_scene(replaced(brake_of_file, "\"curve_4\"", "\"rim\""), "scene.toml");
  try {
    check_groups(scene, many);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).ends_with("\"curve_29\" and 12 more")) << error.what();
  }
}

}  // namespace
}  // namespace chladni::scene
