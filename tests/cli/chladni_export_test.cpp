// `chladni check` and `chladni export`, run as their user does.
#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>

#include "mbs_export/files/body_files.hpp"
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
  EXPECT_LE(std::ranges::count(example, '\n'), 20);
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

TEST(ChladniExport, WritesMatricesThatScipyReadsBitByBit)
{
  const Folder folder;
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", wheel());
  const std::string command = chladni_program + " export disc.reduced.h5 --format matrix-market";
  EXPECT_EQ(run(folder, command).exit_code, 0);
  write_text(folder.path() / "read.py", R"(
import csv, h5py, numpy as np, scipy.io
with h5py.File("disc.reduced.h5") as file:
    K, M, n = file["matrices/stiffness"][()], file["matrices/mass"][()], len(file["masters/node"])
assert np.array_equal(scipy.io.mmread("disc.K.mtx"), np.tril(K) + np.tril(K, -1).T)
assert np.array_equal(scipy.io.mmread("disc.M.mtx"), np.tril(M) + np.tril(M, -1).T)
rows = list(csv.DictReader(open("disc.coordinates.csv")))
assert [int(row["row"]) for row in rows] == list(range(1, len(K) + 1))
assert sum(row["kind"] == "node" for row in rows) == n
assert all(float(row["frequency_Hz"]) > 0 for row in rows[n:])
print(rows[0]["set"], rows[0]["component"])
)");
  const Ending read = run(folder, "/usr/bin/python3 read.py");
  EXPECT_EQ(read.exit_code, 0) << read.err;
  EXPECT_EQ(run(folder, command + " --output a.mtx").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "a.K.mtx"));
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

/// Writes the reduced system of a wheel with damping between its nodes, and with a spring (N/m) and
/// a damper (N s/m) from its hub to the ground along z.
void write_grounded_wheel(const Folder& folder, double stiffness, double damping)
{
  mbs_export::ReducedSystem reduced = wheel();
  const Eigen::Index hub_z = reduced.n_masters() - 4;
  reduced.K(hub_z, hub_z) += stiffness;
  reduced.C = 1e-5 * wheel().K;
  reduced.C(hub_z, hub_z) += damping;
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", reduced);
}

/// The example's scene with twelve nodes on its ring, nothing said of damping, and more at its end.
std::string scene_with(const std::string& more)
{
  const std::string scene = read_text(CHLADNI_SOURCE_DIR "/examples/thesis_disc/scene.toml");
  return replaced(replaced(scene, "nodes = 60", "nodes = 12"), "damping = { type = \"none\" }\n",
                  "") +
         "\n" + more + "\n";
}

std::string line_of_last(const std::string& text)
{
  return std::to_string(std::ranges::count(text, '\n'));
}

TEST(ChladniExport, NamesTheDamperToTheGroundThatAFormatCannotHold)
{
  const Folder folder;
  write_grounded_wheel(folder, 0.0, 7.5);
  const std::string scene = scene_with(
      "[[spring]]\nat = \"track\"\nto = \"hub\"\ndamping = { z = 1.0 }\n"
      "[[spring]]\nat = \"hub\"\ndamping = { z = 7.5 }");
  write_text(folder.path() / "scene.toml", scene);
  for (const std::string format : {"mbdyn", "mbdyn-develop", "sid", "exudyn"}) {
    const Ending ending = run(folder, chladni_program + " export scene.toml --format " + format);
    EXPECT_EQ(ending.exit_code, 1);
    EXPECT_EQ(ending.err.find("scene.toml:" + line_of_last(scene) +
                              ": spring[2].damping: at \"hub\": "
                              "a damper to the ground"),
              0u)
        << ending.err;
  }
  const Ending held = run(folder, chladni_program + " export scene.toml --format nastran-dmig");
  EXPECT_EQ(held.exit_code, 0) << held.err;
  EXPECT_NE(read_text(folder.path() / "disc.dmig").find("DMIG    BRED"), std::string::npos);
  EXPECT_EQ(folder.n_files(), 3u);
}

TEST(ChladniExport, NamesTheSpringToTheGround)
{
  const Folder folder;
  write_grounded_wheel(folder, 1e6, 0.0);
  const std::string scene = scene_with("[[spring]]\nat = \"hub\"\nstiffness = { z = 1e6 }");
  write_text(folder.path() / "scene.toml", scene);
  Ending ending = run(folder, chladni_program + " export scene.toml --format sid");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_EQ(ending.err.find("scene.toml:" + line_of_last(scene) +
                            ": spring.stiffness: at \"hub\": "
                            "a spring to the ground"),
            0u)
      << ending.err;
  write_text(folder.path() / "scene.toml", scene_with(""));
  ending = run(folder, chladni_program + " export scene.toml --format sid");
  EXPECT_NE(ending.err.find("the scene has none now"), std::string::npos) << ending.err;
}

TEST(ChladniExport, NamesFileAndLineOfWhatAFormatCannotHold)
{
  const Folder folder;
  mbs_export::ReducedSystem reduced = wheel();
  reduced.mass_integrals.reset();
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", reduced);
  const std::string scene =
      replaced(scene_with(""), "modes = 100", "modes = 100\nmass_integrals = false");
  const auto line = [](const std::string& text, const std::string& key) {
    const auto end = text.begin() + std::ptrdiff_t(text.find(key));
    return "scene.toml:" + std::to_string(1 + std::count(text.begin(), end, '\n')) + ": ";
  };
  const auto refusal = [&](const std::string& text, const std::string& format) {
    write_text(folder.path() / "scene.toml", text);
    const Ending ending = run(folder, chladni_program + " export scene.toml --format " + format);
    EXPECT_EQ(ending.exit_code, 1);
    return ending.err;
  };
  EXPECT_EQ(refusal(scene, "sid")
                .find(line(scene, "mass_integrals") + "reduce.mass_integrals = false: SID_FEM"),
            0u);
  EXPECT_EQ(refusal(scene, "mbdyn").find(line(scene, "fixed = ") + "body.fixed = "), 0u);
  const std::string greedy = replaced(scene, "keep = { modes = 40 }", "keep = { modes = 4000 }");
  EXPECT_EQ(refusal(greedy, "exudyn").find(line(greedy, "keep = ") + "body.keep"), 0u)
      << refusal(greedy, "exudyn");
}

TEST(ChladniExport, SaysWhichDampingOfTheBodyIsLeftOut)
{
  const Folder folder;
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", wheel());
  const std::string free = replaced(scene_with(""), "fixed = [\"hub\"]", "fixed = []");
  const std::string no_squeal = free.substr(0, free.find("[squeal]"));
  const auto said = [&](const std::string& damping, const std::string& format) {
    write_text(folder.path() / "scene.toml",
               replaced(no_squeal, "keep = { modes = 40 }",
                        "keep = { modes = 40 }\ndamping = " + damping));
    const Ending ending =
        run(folder, chladni_program + " export scene.toml --json out.json --format " + format);
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    return ending.out;
  };
  const std::string modal = "{ type = \"modal\", ratio = 0.01 }",
                    rayleigh = "{ type = \"rayleigh\", alpha = 3.0, beta = 1e-7 }";
  EXPECT_NE(said(modal, "exudyn").find("note: [body] damping (type = \"modal\") is left out"),
            std::string::npos);
  EXPECT_NE(read_text(folder.path() / "out.json").find("\"notes\": [\"[body] damping"),
            std::string::npos);
  EXPECT_NE(said(rayleigh, "nastran-dmig").find("note: [body] damping (type = \"rayleigh\")"),
            std::string::npos);
  EXPECT_NE(said(rayleigh, "mbdyn").find("note: [body] damping.alpha is left out"),
            std::string::npos);
  for (const std::string format : {"mbdyn", "sid"})
    EXPECT_EQ(said(modal, format).find("note:"), std::string::npos);
  EXPECT_EQ(said("{ type = \"none\" }", "exudyn").find("note:"), std::string::npos);
}

TEST(ChladniExport, SaysWhichStiffeningIsLeftOut)
{
  const Folder folder;
  mbs_export::ReducedSystem reduced = wheel();
  const Eigen::MatrixXd K = Eigen::MatrixXd::Identity(reduced.K.rows(), reduced.K.rows());
  reduced.stiffening = {.fixed = {}, .loads = {"omega_zz"}, .K = {K}};
  mbs_export::write_reduced(folder.path() / "disc.reduced.h5", reduced);
  const std::string held = scene_with("").substr(0, scene_with("").find("[squeal]"));
  const std::string free = replaced(held, "fixed = [\"hub\"]", "fixed = []");
  const auto said = [&](const std::string& scene, const std::string& format) {
    write_text(folder.path() / "scene.toml", scene);
    const Ending ending = run(folder, chladni_program + " export scene.toml --format " + format);
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    return ending.out;
  };
  const std::string note = "note: the geometric stiffening is left out";
  for (const std::string format :
       {"matrix-market", "nastran-dmig", "nastran-op4", "mbdyn", "exudyn"}) {
    const std::string text = said(free, format);
    EXPECT_NE(text.find(note + ": " + format + " has no place for it"), std::string::npos) << text;
  }
  for (const std::string format : {"mbdyn-develop", "sid"})
    EXPECT_EQ(said(free, format).find(note), std::string::npos) << format;
  for (const std::string format : {"mbdyn-develop", "sid"}) {
    const std::string text = said(held, format);
    EXPECT_NE(text.find(note + ": the reduced system has that of fixed = []"), std::string::npos)
        << text;
  }
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
