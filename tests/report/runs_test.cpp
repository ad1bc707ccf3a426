#include "report/page/pages.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "common/error.hpp"

namespace chladni::report {
namespace {

using std::filesystem::path;

struct Runs : testing::Test {
  Runs()
  {
    std::filesystem::create_directories(folder);
    std::ifstream example(path(CHLADNI_SOURCE_DIR) / "examples/rigid_disc/scene.toml");
    const std::string text{std::istreambuf_iterator<char>(example), {}};
    for (const std::string name : {"one", "other"}) {
      const std::string named =
          std::regex_replace(text, std::regex("\"rigid\" "), '"' + name + '"');
      std::ofstream(folder / (name + ".toml"))
          << std::regex_replace(named, std::regex("Rigid disc of.*"), "Disc\"");
    }
  }
  ~Runs() override { std::filesystem::remove_all(folder); }

  std::string file(const char* name) const { return (folder / name).string(); }
  path folder = path(testing::TempDir()) / "runs_test";
};

TEST_F(Runs, OneFolderGoesWithAllScenesAndOneSceneWithAllFolders)
{
  const auto scenes = runs_of({.scenes = {file("one.toml"), file("other.toml")}, .outputs = {"a"}});
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_EQ(scenes[1].scene.name, "other");
  EXPECT_EQ(scenes[1].folder, "a");
  const auto folders = runs_of({.scenes = {file("one.toml")}, .outputs = {"a", "b"}});
  ASSERT_EQ(folders.size(), 2U);
  EXPECT_EQ(folders[1].scene.name, "one");
  EXPECT_EQ(folders[1].folder, "b");
}

TEST_F(Runs, ThreeFoldersDoNotGoWithTwoScenes)
{
  EXPECT_THROW(
      runs_of({.scenes = {file("one.toml"), file("other.toml")}, .outputs = {"a", "b", "c"}}),
      Error);
}

TEST_F(Runs, AreToldApartByWhatDiffers)
{
  const auto folders = runs_of({.scenes = {file("one.toml")}, .outputs = {"a", "b"}});
  EXPECT_EQ(labels_of(folders), (std::vector<std::string>{"a", "b"})) << "the titles are the same";
  auto titled = runs_of({.scenes = {file("one.toml"), file("other.toml")}, .outputs = {"a"}});
  titled[1].scene.title = "Stiffer disc";
  EXPECT_EQ(labels_of(titled), (std::vector<std::string>{"Disc", "Stiffer disc"}));
  titled[1].scene.title = "Disc";
  EXPECT_EQ(labels_of(titled)[1], file("other.toml")) << "titles and folders are the same";
}

}  // namespace
}  // namespace chladni::report
