// `chladni check` and `chladni export`, run as their user does.
#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>

#include "mbs_export/files/body_file.hpp"
#include "mbs_export/files/reduced_file.hpp"
#include "mbs_export/make_body.hpp"
#include "tests/cli/programs.hpp"
#include "tests/mbs_export/wheel.hpp"

namespace chladni::cli::testing {
namespace {

const std::string chladni_program = "'" CHLADNI_PROGRAM "'";

/// The wheel of twelve nodes with the names of the example's scene.
mbs_export::ReducedSystem wheel()
{
  mbs_export::ReducedSystem wheel = mbs_export::test::wheel();
  wheel.sets[0].name = "track";
  return wheel;
}

TEST(ChladniCheck, PassesSoundFilesAndFailsSpoiledOnes)
{
  const Folder folder;
  mbs_export::ReducedSystem reduced = wheel();
  mbs_export::write_reduced(folder.path() / "sound.reduced.h5", reduced);
  mbs_export::write_body(folder.path() / "sound.body.h5", mbs_export::make_body(reduced, {}));
  reduced.M(7, 7) *= 1.01;
  mbs_export::write_reduced(folder.path() / "spoiled.reduced.h5", reduced);
  for (const std::string file : {"sound.reduced.h5", "sound.body.h5"}) {
    const Ending ending = run(folder, chladni_program + " check " + file);
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    EXPECT_NE(ending.out.find("rigid modes"), std::string::npos) << ending.out;
    EXPECT_EQ(ending.out.find("FAIL"), std::string::npos) << ending.out;
  }
  EXPECT_EQ(run(folder, chladni_program + " check sound.body.h5 --json out.json").exit_code, 0);
  const std::string json = read_text(folder.path() / "out.json");
  EXPECT_NE(json.find("\"check\": \"mass integrals\", \"verdict\": \"pass\""), std::string::npos)
      << json;
  const Ending ending = run(folder, chladni_program + " check spoiled.reduced.h5");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.out.find("FAIL: mass of rigid motions"), std::string::npos) << ending.out;
  EXPECT_NE(ending.err.find("checks failed"), std::string::npos) << ending.err;
}

TEST(ReadBodyExample, ReadsWhatIsWritten)
{
  const Folder folder;
  mbs_export::write_body(folder.path() / "a.body.h5", mbs_export::make_body(wheel(), {}));
  const Ending ending =
      run(folder, "/usr/bin/python3 '" CHLADNI_SOURCE_DIR "/examples/read_body.py' a.body.h5");
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_NE(ending.out.find("wheel: 1.7 kg"), std::string::npos) << ending.out;
  EXPECT_NE(ending.out.find("ring track, radius 0.1 m"), std::string::npos) << ending.out;
  const std::string example = read_text(CHLADNI_SOURCE_DIR "/examples/read_body.py");
  EXPECT_LE(std::count(example.begin(), example.end(), '\n'), 20);
}

TEST(ChladniExport, WritesTheFilesOfNastran)
{
  const Folder folder;
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", wheel());
  const std::string command = chladni_program + " export disc.reduced.h5 --format ";
  EXPECT_EQ(run(folder, command + "nastran-dmig").exit_code, 0);
  EXPECT_NE(read_text(folder.path() / "disc.dmig").find("DMIG    KRED"), std::string::npos);
  EXPECT_EQ(run(folder, command + "nastran-op4 --output se.op4 --superelement 7").exit_code, 0);
  EXPECT_NE(read_text(folder.path() / "se.op4").find("KAA     1P,3E23.16"), std::string::npos);
  EXPECT_NE(read_text(folder.path() / "se.asm").find("SEBULK         7"), std::string::npos);
  EXPECT_NE(read_text(folder.path() / "se.pch").find("BEGIN SUPER       7"), std::string::npos);
  EXPECT_EQ(folder.n_files(), 5u);
}

TEST(ChladniExport, WritesTheBodyOfASceneForMbdyn)
{
  const Folder folder;
  const std::string scene = replaced(
      read_text(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml"), "nodes = 60", "nodes = 12");
  write_text(folder.path() / "scene.toml", scene);
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", wheel());
  const std::string command = chladni_program + " export scene.toml --format ";
  EXPECT_EQ(run(folder, command + "mbdyn-develop").exit_code, 0);
  EXPECT_NE(read_text(folder.path() / "disc.fem").find("** RECORD GROUP 14"), std::string::npos);
  const Ending old = run(folder, command + "mbdyn");  // the scene holds its hub
  EXPECT_EQ(old.exit_code, 1);
  EXPECT_NE(old.err.find("MBDyn 1.7"), std::string::npos) << old.err;
}

TEST(ChladniExport, WritesTheBodyOfASceneForOthersAndSaysSoInJson)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml",
             replaced(read_text(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml"),
                      "nodes = 60", "nodes = 12"));
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", wheel());
  const std::string command = chladni_program + " export scene.toml --format ";
  EXPECT_EQ(run(folder, command + "sid --sid-dialect welib --json out.json").exit_code, 0);
  EXPECT_NE(read_text(folder.path() / "disc.SID_FEM").find("end part"), std::string::npos);
  EXPECT_NE(read_text(folder.path() / "out.json").find("\"files\": [\"disc.SID_FEM\"]"),
            std::string::npos);
  EXPECT_EQ(run(folder, command + "sid --sid-dialect other").exit_code, 2);
  const std::string by_mode = read_text(folder.path() / "disc.SID_FEM");
  EXPECT_EQ(run(folder, command + "sid --sid-dialect welib --sid-gyroscopic by-axis").exit_code, 0);
  EXPECT_NE(read_text(folder.path() / "disc.SID_FEM"), by_mode);
  EXPECT_EQ(run(folder, command + "exudyn").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "disc.exudyn.hdf5"));
}

TEST(ChladniExport, SaysWhatIsMissing)
{
  const Folder folder;
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", wheel());
  const std::string command = chladni_program + " export disc.reduced.h5";
  EXPECT_EQ(run(folder, command).exit_code, 2);
  EXPECT_EQ(run(folder, command + " --format tea-leaves").exit_code, 2);
  const Ending ending = run(folder, command + " --format mbdyn");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_NE(ending.err.find("give the scene"), std::string::npos) << ending.err;
  EXPECT_EQ(folder.n_files(), 1u);
}

TEST(ChladniExport, HelpsWithExamples)
{
  const Folder folder;
  for (const std::string subcommand : {" check", " export"}) {
    const Ending ending = run(folder, chladni_program + subcommand + " --help");
    EXPECT_EQ(ending.exit_code, 0);
    EXPECT_NE(ending.out.find("Example"), std::string::npos) << ending.out;
  }
}

}  // namespace
}  // namespace chladni::cli::testing
