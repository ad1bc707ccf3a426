// What the program `squeal` answers to mistakes: one message that names them, and no file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "mbs_export/files/body_files.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/cli/two_mode_body.hpp"

namespace chladni::cli::testing {
namespace {

const std::string program_under_test = "'" SQUEAL_PROGRAM "'";

/// The example with these analyses alone.
std::string scene_with(const std::string& analyses)
{
  const std::string scene = example_scene();
  const std::size_t at = scene.find("analyses = ");
  return replaced(scene, scene.substr(at, scene.find('\n', at) - at),
                  "analyses = [" + analyses + "]");
}

/// How the program ends on a scene and a body.
struct Attempt {
  Ending ending;
  std::size_t n_files;  ///< besides scene and body
};

Attempt attempt(const std::string& scene, const mbs_export::ModalBody& body)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", scene);
  mbs_export::write_body(folder.path() / "disc.body.h5", body);
  const Ending ending = run(folder, program_under_test + " run scene.toml --json summary.json");
  return {ending, folder.n_files() - 2};
}

void expect_refusal(const Attempt& attempt, const std::vector<std::string>& words)
{
  EXPECT_EQ(attempt.ending.exit_code, 1);
  EXPECT_EQ(attempt.n_files, 0u);
  EXPECT_EQ(std::ranges::count(attempt.ending.err, '\n'), 1) << attempt.ending.err;
  for (const std::string& word : words)
    EXPECT_NE(attempt.ending.err.find(word), std::string::npos) << attempt.ending.err;
}

TEST(SquealBadInput, IsNamedWithItsLineInTheScene)
{
  const std::string transient = scene_with("\"transient\"");
  const struct {
    std::string scene;
    std::vector<std::string> words;
  } mistakes[] = {
      {replaced(transient, "friction = 0.6", "friction = -0.6"), {"squeal.friction", "-0.6"}},
      {replaced(transient, "from_rad_s = 3.14159", "from_rad_s = 0.0"), {"from_rad_s", "> 0"}},
      {replaced(transient, "{ speed_rad_s = 18.8495559", "{ speed_rad_s = 0.0"),
       {"transient.speed_rad_s", "> 0"}},
      {replaced(transient, "duration_s = 6.0,", "duration_s = 6.0, steps_per_period = 4,"),
       {"steps_per_period", "4", ">= 8"}},
      {replaced(transient, "radius = 0.13, nodes", "radius = 0.2, nodes"),
       {"mesh.rings.radius", "0.162"}},
      {replaced(transient, "ring = \"track\"", "ring = \"trak\""), {"squeal.ring", "track"}},
      {replaced(transient, "angle_deg = 0.0,",
                "angle_deg = 0.0, grid = { sector_deg = 40.0, points = 3, rings = [\"rim\"] },"),
       {"rings", "rim"}},
      {replaced(transient, "angle_deg = 0.0", "angle_deg = nan"), {"angle_deg", "nan"}},
  };
  for (const auto& mistake : mistakes) {
    SCOPED_TRACE(mistake.words.front());
    expect_refusal(attempt(mistake.scene, kirchhoff_body()), mistake.words);
  }
}

TEST(SquealBadInput, IsNamedWithWhatTheBodyLacks)
{
  const std::string scene = scene_with("\"eigenvalues\"");
  auto without_ring = kirchhoff_body();
  without_ring.sets.clear();
  without_ring.rings.clear();
  expect_refusal(attempt(scene, without_ring), {"no contact ring 'track'"});
  // Held where the pads touch, so that it cannot vibrate there.
  auto held = kirchhoff_body();
  for (auto member :
       {&mbs_export::ContactRing::W, &mbs_export::ContactRing::W_r, &mbs_export::ContactRing::W_t})
    (held.rings[0].*member).setZero();
  expect_refusal(attempt(scene, held), {"track", "no mode"});
}

TEST(SquealBadInput, OfAFileIsFoundBeforeItIsUsed)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", scene_with("\"eigenvalues\""));
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  // The frequencies stand in the file as they are in memory: a NaN in the place of the first.
  std::string bytes = read_text(folder.path() / "disc.body.h5");
  const double omega = kirchhoff_body().omega[0], nan = std::nan("");
  const std::string number(reinterpret_cast<const char*>(&omega), sizeof omega);
  const std::size_t at = bytes.find(number);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, sizeof nan, reinterpret_cast<const char*>(&nan), sizeof nan);
  std::ofstream(folder.path() / "disc.body.h5", std::ios::binary) << bytes;
  const Ending unsealed = run(folder, program_under_test + " run scene.toml");
  EXPECT_EQ(unsealed.exit_code, 1);
  EXPECT_NE(unsealed.err.find("squeal seal"), std::string::npos) << unsealed.err;
  EXPECT_EQ(run(folder, program_under_test + " seal disc.body.h5").exit_code, 0);
  const Ending ending = run(folder, program_under_test + " run scene.toml");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.err.find("nan"), std::string::npos) << ending.err;
  EXPECT_EQ(folder.n_files(), 2u);
}

/// A spring that stiffens so much beyond its linear range is too stiff for the steps.
void expect_divergence(const Folder& folder, const std::string& analyses)
{
  std::string scene = scene_with(analyses);
  scene = replaced(scene, "stiffness = 6e6,", "stiffness = 6e6, cubic_stiffness = 1e16,");
  scene = replaced(scene, "initial_pad_displacement = 6.8e-8", "initial_pad_displacement = 0.05");
  write_text(folder.path() / "scene.toml", scene);
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending = run(folder, program_under_test + " run scene.toml");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.err.find("diverged"), std::string::npos) << ending.err;
}

TEST(SquealBadInput, ThatDivergesLeavesAReadableFile)
{
  const Folder folder;
  expect_divergence(folder, "\"eigenvalues\", \"transient\", \"limit-cycle\"");
  const auto results = squeal::read_results(folder.path() / "disc.squeal.h5");
  EXPECT_TRUE(results.eigenvalues);
  ASSERT_TRUE(results.transient);
  EXPECT_FALSE(results.transient->finished);
  ASSERT_TRUE(results.failure);
}

TEST(SquealBadInput, ThatDivergesInATransientAloneFailsToo)
{
  const Folder folder;
  expect_divergence(folder, "\"transient\"");
}

TEST(SquealProgram, LeavesNothingBehindWhenTheSceneIsWrong)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml",
             replaced(example_scene(), "friction = 0.6", "friction = -0.6"));
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending = run(folder, program_under_test + " run scene.toml --json summary.json");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_EQ(ending.err, "scene.toml:54: squeal.friction = -0.6: must be >= 0\n");
  EXPECT_EQ(folder.n_files(), 2u);
}

TEST(SquealReport, RefusesResultsOfAnotherBodyByName)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", example_scene());
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  std::filesystem::copy_file(CHLADNI_SOURCE_DIR "/tests/data/version_1.squeal.h5",
                             folder.path() / "disc.squeal.h5");
  const Ending ending = run(folder, program_under_test + " report scene.toml");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(
      ending.err.find("disc.squeal.h5: the results of squeal name mode 3, and the body has 2"),
      std::string::npos)
      << ending.err;
  EXPECT_EQ(folder.n_files(), 3u);
}

TEST(SquealProgram, RefusesAFileThatIsNoBody)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", example_scene());
  write_text(folder.path() / "disc.body.h5", "not HDF5");
  const Ending ending = run(folder, program_under_test + " run scene.toml");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.err.find("disc.body.h5"), std::string::npos) << ending.err;
  EXPECT_EQ(folder.n_files(), 2u);
}

}  // namespace
}  // namespace chladni::cli::testing
