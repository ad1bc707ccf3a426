// `squeal sweep`, run as its user does, on a body whose squeal is known.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "common/files/hdf5.hpp"
#include "mbs_export/files/body_files.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "tests/cli/programs.hpp"
#include "tests/cli/two_mode_body.hpp"

namespace chladni::cli::testing {
namespace {

const std::string program = "'" SQUEAL_PROGRAM "' ";

/// The brake of two modes with other analyses; pads and friction are the example's.
std::string scene_of(const std::string& analyses, const std::string& more = "")
{
  const std::string scene = example_scene();
  const std::size_t from = scene.find("\nanalyses =") + 1;
  return scene.substr(0, from) + "analyses = [" + analyses + "]\n" + more +
         scene.substr(scene.find('\n', from) + 1);
}

void prepare_sweep(const Folder& folder, const std::string& scene)
{
  write_text(folder.path() / "scene.toml", scene);
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
}

squeal::SweepTable table_of(const Folder& folder)
{
  return squeal::read_sweep(files::Reader((folder.path() / "disc.sweep.h5").string()));
}

std::vector<std::string> lines_of(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(SquealSweep, HasForEachVariantWhatARunOfItsSceneFinds)
{
  const Folder folder;
  const std::string scene = scene_of("\"critical-speed\", \"stability\"");
  prepare_sweep(folder, scene);
  const Ending ending = run(folder, program +
                                        "sweep scene.toml --vary squeal.friction=0.6,0.5 "
                                        "--vary squeal.pads.stiffness=5e6:6e6:3 --json s.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_EQ(number_at(read_text(folder.path() / "s.json"), "done"), 6.0);
  const squeal::SweepTable sweep = table_of(folder);
  ASSERT_EQ(sweep.values.rows(), 6);
  EXPECT_EQ(sweep.values.row(4), Eigen::RowVector2d(0.5, 5.5e6));
  EXPECT_EQ(sweep.columns.front().name, "critical_speed_rad_s");

  write_text(folder.path() / "scene.toml",
             replaced(replaced(scene, "friction = 0.6", "friction = 0.5"), "stiffness = 6e6",
                      "stiffness = 5.5e6"));
  ASSERT_EQ(run(folder, program + "run scene.toml").exit_code, 0);
  const auto alone = squeal::read_results(folder.path() / "disc.squeal.h5");
  EXPECT_EQ(sweep.results(4, 0), alone.critical_speed.value().speed);
  EXPECT_EQ(sweep.results(4, 1), alone.critical_speed->frequency_Hz);
  EXPECT_EQ(sweep.results(4, 6), 1.0) << sweep.columns[6].name;

  const auto csv = lines_of(read_text(folder.path() / "disc.sweep.csv"));
  ASSERT_EQ(csv.size(), 7u);
  EXPECT_EQ(csv[0].substr(0, 65),
            "variant,squeal.friction,squeal.pads.stiffness,critical_speed_rad_");
  EXPECT_EQ(csv[5].substr(0, 14), "5,0.5,5500000,");
  EXPECT_EQ(std::stod(csv[5].substr(14)), sweep.results(4, 0));
}

/// 400 variants of friction and preload.
const std::string many =
    "sweep scene.toml --vary squeal.friction=0.3:0.7:20 "
    "--vary squeal.pads.preload=1500:2500:20 ";

TEST(SquealSweep, ThatWasKilledGoesOnToTheSameFileBitByBit)
{
  const Folder whole, killed;
  for (const Folder* folder : {&whole, &killed})
    prepare_sweep(*folder, scene_of("\"critical-speed\""));
  ASSERT_EQ(run(whole, program + many + "--threads 1").exit_code, 0);
  // It leaves a state behind as soon as it has begun; the next one, another file, has a variant.
  const std::string state = "$(stat -c %i disc.sweep.h5 2> /dev/null)";
  const Ending ending =
      run(killed, "{ " + program + many + "--checkpoint 0 & while kill -0 $! && [ -z \"" + state +
                      "\" ]; do sleep 0.01; done; "
                      "first=" +
                      state + "; while kill -0 $! && [ \"" + state +
                      "\" = \"$first\" ]; do sleep 0.01; done; kill -9 $!; wait $!; }");
  ASSERT_EQ(ending.exit_code, 137);
  const squeal::SweepTable left = table_of(killed);
  EXPECT_GT(left.count(squeal::VariantState::done), 0u);
  EXPECT_GT(left.count(squeal::VariantState::to_do), 0u);
  EXPECT_FALSE(exists(killed.path() / "disc.sweep.csv"));

  const Ending anew = run(killed, program + many);
  EXPECT_EQ(anew.exit_code, 1) << "what is done is not given up without a word";
  EXPECT_NE(anew.err.find("--resume goes on from it"), std::string::npos) << anew.err;
  const Ending other =
      run(killed, program + "sweep scene.toml --vary squeal.friction=0.3 --resume");
  EXPECT_NE(other.err.find("cannot be resumed, since other keys vary"), std::string::npos)
      << other.err;
  const Ending resumed = run(killed, program + many + "--resume --threads 2");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  for (const char* file : {"disc.sweep.h5", "disc.sweep.csv"})
    EXPECT_TRUE(read_text(killed.path() / file) == read_text(whole.path() / file)) << file;
}

TEST(SquealSweep, ListsVariantsThatFailAndGoesOn)
{
  // Without friction nothing squeals, and there is no limit cycle to find.
  const Folder folder;
  prepare_sweep(folder, scene_of("\"critical-speed\", \"limit-cycle-direct\""));
  write_text(folder.path() / "samples.csv",
             "squeal.friction, squeal.pads[1].preload\n"
             "0.6, 2000\r\n0.0,2000\n\n0.6,2100\n");
  const Ending ending = run(folder, program + "sweep scene.toml --samples samples.csv");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  const squeal::SweepTable sweep = table_of(folder);
  EXPECT_EQ(sweep.states, (std::vector{squeal::VariantState::done, squeal::VariantState::failed,
                                       squeal::VariantState::done}));
  EXPECT_NE(sweep.failures[1], "");
  EXPECT_EQ(sweep.known(1, 0), 0) << "no critical speed";
  EXPECT_EQ(sweep.known(1, 2), 1) << "what came before the failure is kept";
  EXPECT_EQ(sweep.results(1, 2), 0.0) << "unstable intervals";
  EXPECT_NE(ending.out.find("variant 2: squeal.friction = 0"), std::string::npos) << ending.out;
  EXPECT_NE(run(folder, program + "info disc.sweep.h5").out.find("variant 2: squeal.friction = 0"),
            std::string::npos);
  const auto csv = lines_of(read_text(folder.path() / "disc.sweep.csv"));
  EXPECT_EQ(csv[2].substr(0, 15), "2,0,2000,,,0,,,") << csv[2];
  EXPECT_NE(csv[2].find(sweep.failures[1].substr(0, 20)), std::string::npos) << csv[2];
}

TEST(SquealSweep, RefusesBeforeTheRunWhatCannotBe)
{
  const Folder folder;
  prepare_sweep(folder,
                scene_of("\"stability\"",
                         "stability = { over = \"friction\", from = 0.1, to = 0.7, count = 3, "
                         "speed_rad_s = 18.8, band_Hz = [1000, 1600] }\n"));
  write_text(folder.path() / "cells.csv", "squeal.thickness\n0.02\n0,02\n");
  write_text(folder.path() / "words.csv", "squeal.thickness\n0.02\nthick\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"--vary squeal.fricton=0.3,0.4", "did you mean squeal.friction?"},
      {"--vary mesh.element_size=0.01,0.02", "only keys of [squeal] can vary"},
      {"--vary squeal.friction=0.3,-0.4", "variant 2 (squeal.friction = -0.4): scene.toml:"},
      {"--vary squeal.friction=0.3,-0.4", "squeal.friction = -0.4: must be >= 0"},
      {"--vary 'squeal.stability.band_Hz[2]=1600,1e6'", "variant 2 (squeal.stability.band_Hz[2]"},
      {"--vary 'squeal.stability.band_Hz[2]=1600,1e6'", "goes beyond the modes of the body, "},
      {"--vary squeal.friction=0.3:0.4", "give KEY=FROM:TO:COUNT"},
      {"--vary squeal.friction=0.3 --vary squeal.friction=0.4", "squeal.friction is there twice"},
      {"--vary squeal.friction=0.3:0.4:3000 --vary squeal.thickness=0.01:0.02:3000",
       "9000000 variants; at most 1000000"},
      {"--samples cells.csv", "cells.csv:3: has 2 numbers for 1 keys"},
      {"--samples words.csv", "words.csv:3: \"thick\" is no finite number"},
      {"--samples none.csv", "none.csv: cannot be read"},
      {"", "give --vary KEY=FROM:TO:COUNT"}};
  for (const auto& [arguments, expected] : cases) {
    const Ending ending = run(folder, program + "sweep scene.toml " + arguments);
    EXPECT_EQ(ending.exit_code, 1) << arguments;
    EXPECT_NE(ending.err.find(expected), std::string::npos) << arguments << ": " << ending.err;
    EXPECT_FALSE(exists(folder.path() / "disc.sweep.h5"));
  }
}

TEST(SquealSweep, TakesTheAnalysesThatYieldNumbers)
{
  const Folder folder;
  prepare_sweep(folder, scene_of("\"eigenvalues\", \"limit-cycle-branch\""));
  const std::string sweep = program + "sweep scene.toml --vary squeal.friction=0.3 ";
  ASSERT_EQ(run(folder, sweep).exit_code, 0);
  EXPECT_EQ(table_of(folder).columns.size(), 3u);
  ASSERT_EQ(run(folder, sweep + "--analyses critical-speed,eigenvalues").exit_code, 0);
  EXPECT_EQ(table_of(folder).columns.size(), 9u);
  const Ending refused = run(folder, sweep + "--analyses limit-cycle-branch");
  EXPECT_NE(refused.err.find("a sweep keeps no numbers of \"limit-cycle-branch\"; it takes "),
            std::string::npos)
      << refused.err;
}

}  // namespace
}  // namespace chladni::cli::testing
