// The program `squeal`, run as its user does, on a body whose squeal is known.
#include <gtest/gtest.h>

#include <numbers>
#include <regex>

#include "common/files/hdf5.hpp"
#include "mbs_export/files/body_files.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/cli/programs.hpp"
#include "tests/cli/two_mode_body.hpp"

namespace chladni::cli::testing {
namespace {

constexpr double pi = std::numbers::pi;
const std::string squeal_program = "'" SQUEAL_PROGRAM "'";

TEST(SquealProgram, ReproducesTheSquealOfTheTwoModeDisc)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", example_scene());
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending =
      run(folder, squeal_program + " run scene.toml --output . --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_EQ(ending.err, "");
  const std::string json = read_text(folder.path() / "summary.json");
  // Newton on the 2 x 2 determinant gives 4.2567454955 pi and 1695.33600615 Hz; the mode data
  // above have 12 digits.
  EXPECT_NEAR(number_at(json, "critical_speed_rad_s") / pi, 4.2567454955, 1e-8);
  EXPECT_NEAR(number_at(json, "critical_frequency_Hz"), 1695.33600615, 1e-6);
  // The eigenvalue at 3.8 pi, the first speed of the list; 40 steps per period put the simulated
  // rate wrong by up to 2e-4 1/s.
  EXPECT_NEAR(number_at(json, "growth_1_s"), -1.036007, 1e-3);
  // Reference: the same model integrated by DOP853; second order in 40 steps per period leaves
  // about 1e-4 of the velocity.
  EXPECT_NEAR(number_at(json, "frequency_Hz"), 1696.8533, 5e-3);
  EXPECT_NEAR(number_at(json, "pad_velocity_m_s"), 6.727, 2e-3);
  EXPECT_NEAR(number_at(json, "pad_displacement_m"), 0.6309e-3, 2e-7);
  EXPECT_NE(json.find("\"program\": \"squeal\""), std::string::npos);
  EXPECT_GT(number_at(json, "peak_MiB"), 1.0);
  EXPECT_NE(ending.out.find("critical speed"), std::string::npos);

  const auto results = squeal::read_results(folder.path() / "disc.squeal.h5");
  ASSERT_TRUE(results.critical_speed);
  EXPECT_EQ(results.critical_speed->speed, number_at(json, "critical_speed_rad_s"));
}

TEST(SquealProgram, SaysThatTheStiffeningOfItsBodyIsNotUsed)
{
  const Folder folder;
  const std::string scene = example_scene();
  const std::size_t analyses = scene.find("analyses = ");
  write_text(folder.path() / "scene.toml",
             replaced(scene, scene.substr(analyses, scene.find('\n', analyses) - analyses),
                      "analyses = [\"critical-speed\"]"));
  mbs_export::ModalBody body = kirchhoff_body();
  body.stiffening = {
      .fixed = body.fixed, .loads = {"omega_zz"}, .K = {Eigen::MatrixXd::Identity(2, 2)}};
  mbs_export::write_body(folder.path() / "disc.body.h5", body);
  const Ending ending = run(folder, squeal_program + " run scene.toml");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_EQ(ending.err.find("note: the geometric stiffening (reduce.stiffening) is not used"), 0u)
      << ending.err;
}

TEST(SquealProgram, FindsTheLimitCycleWithoutATransient)
{
  const Folder folder;
  const std::string scene = example_scene();
  const std::size_t analyses = scene.find("analyses = ");
  write_text(
      folder.path() / "scene.toml",
      replaced(scene, scene.substr(analyses, scene.find('\n', analyses) - analyses),
               "analyses = [\"limit-cycle-direct\", \"limit-cycle-branch\", \"stability-map\"]"));
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending = run(folder, squeal_program + " run scene.toml --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  const std::string json = read_text(folder.path() / "summary.json");
  EXPECT_NE(json.find("\"limit_cycle_direct\": {"), std::string::npos);
  // The mode data above have 12 digits, the speed of the scene has nine.
  EXPECT_NEAR(number_at(json, "frequency_Hz"), 1696.8533, 1e-4);
  EXPECT_NEAR(number_at(json, "pad_velocity_m_s"), 6.7274, 1e-4);
  EXPECT_NE(ending.out.find("direct limit cycle: pad velocity"), std::string::npos);
  EXPECT_NE(json.find("\"limit_cycle_branch\": ["), std::string::npos);
  const auto results = squeal::read_results(folder.path() / "disc.squeal.h5");
  ASSERT_TRUE(results.map && results.limit_cycle_branch);
  EXPECT_EQ(results.map->growth.size(), 60 * 41);
  // Speeds of 1 to 20 pi in 60 steps, unstable from 4.257 pi: the eleventh is 4.22 pi.
  EXPECT_EQ(results.limit_cycle_branch->points.size(), 49u);
}

TEST(SquealProgram, WritesSpectrumSoundAndCriticalValues)
{
  const Folder folder;
  const std::string scene = example_scene();
  const std::size_t analyses = scene.find("analyses = ");
  write_text(folder.path() / "scene.toml",
             replaced(scene, scene.substr(analyses, scene.find('\n', analyses) - analyses),
                      "analyses = [\"spectrum\", \"critical-values\"]\n"
                      "wav = { rate_Hz = 44100 }\n"
                      "critical = [{ parameter = \"friction\", from = 0.1, to = 1.0, "
                      "speed_rad_s = 18.8495559 }]"));
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending = run(folder, squeal_program + " run scene.toml --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_NE(ending.out.find("full scale"), std::string::npos);
  // 6 s of 16-bit samples and their headers.
  EXPECT_NEAR(double(std::filesystem::file_size(folder.path() / "disc.wav")), 2.0 * 6.0 * 44100.0,
              200.0);
  const auto results = squeal::read_results(folder.path() / "disc.squeal.h5");
  ASSERT_TRUE(results.spectrum && !results.spectrum->peaks.empty());
  // Lines of 17 Hz, refined between them.
  EXPECT_NEAR(results.spectrum->peaks[0].frequency_Hz, 1696.85, 0.2);
  EXPECT_NEAR(results.spectrum->peaks[0].amplitude, 6.727, 0.02);
  // Without damping of the disc, friction does not decide.
  ASSERT_EQ(results.critical_values.size(), 1u);
  EXPECT_FALSE(results.critical_values[0].value);
  EXPECT_NE(ending.out.find("critical friction at 18.8496 rad/s (180 rpm)"), std::string::npos);
  EXPECT_EQ(results.transient->integrator, "exponential");
}

TEST(SquealProgram, DescribesBodiesAndResults)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", example_scene());
  mbs_export::write_body(folder.path() / "other.h5", kirchhoff_body());
  ASSERT_EQ(run(folder, squeal_program + " run scene.toml --body other.h5").exit_code, 0);
  const Ending results = run(folder, squeal_program + " info disc.squeal.h5");
  EXPECT_EQ(results.exit_code, 0) << results.err;
  EXPECT_NE(results.out.find("critical frequency"), std::string::npos);
  const Ending body = run(folder, squeal_program + " info other.h5");
  EXPECT_EQ(body.exit_code, 0) << body.err;
  EXPECT_NE(body.out.find("1672.1300"), std::string::npos);
}

TEST(SquealProgram, TellsTheScenesOfTheBodyThatItUsed)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", example_scene());
  mbs_export::ModalBody body = kirchhoff_body();
  body.provenance.scene = "title = \"yesterday's\"";
  body.provenance.reduction_scene = "title = \"older still\"";
  mbs_export::write_body(folder.path() / "disc.body.h5", body);
  ASSERT_EQ(run(folder, squeal_program + " run scene.toml").exit_code, 0);
  const files::Reader results((folder.path() / "disc.squeal.h5").string());
  EXPECT_EQ(results.text("provenance/scene"), example_scene());
  EXPECT_EQ(results.text("provenance/body_scene"), body.provenance.scene);
  EXPECT_EQ(results.text("provenance/reduction_scene"), body.provenance.reduction_scene);
}

TEST(SquealProgram, RunsTheModelsThatNeedNoBody)
{
  const Folder folder;
  write_text(folder.path() / "rigid.toml",
             read_text(CHLADNI_SOURCE_DIR "/examples/rigid_disc/scene.toml"));
  const Ending rigid = run(folder, squeal_program + " run rigid.toml --json summary.json");
  ASSERT_EQ(rigid.exit_code, 0) << rigid.err;
  // A slow machine tells after ten seconds how far it is.
  static const std::regex progress("[0-9]+ s: [0-9]+ %[^\n]*\n");
  EXPECT_EQ(std::regex_replace(rigid.err, progress, ""), "");
  const std::string json = read_text(folder.path() / "summary.json");
  // Reference value with 40 digits; the growth rate is known to 1e-9 and rises by 0.03 per rad/s.
  EXPECT_NEAR(number_at(json, "critical_speed_rad_s") / pi, 9.478465586019481, 1e-7);
  // The limit cycle at 20 pi, approached by exp(-0.6 t) over 10 s.
  EXPECT_NEAR(number_at(json, "pad_velocity_m_s"), 11.52144, 2e-2);
  const auto results = squeal::read_results(folder.path() / "rigid.squeal.h5");
  ASSERT_TRUE(results.eigenvalues && results.limit_cycle);
  // At 10.4 pi, where the source has its critical speed, it already grows.
  EXPECT_NEAR(results.growth.at(1).rate, 0.0797, 5e-4);

  write_text(folder.path() / "mass.toml",
             read_text(CHLADNI_SOURCE_DIR "/examples/oscillator/scene.toml"));
  const Ending mass = run(folder, squeal_program + " run mass.toml");
  ASSERT_EQ(mass.exit_code, 0) << mass.err;
  EXPECT_NE(run(folder, squeal_program + " run mass.toml --body rigid.toml").exit_code, 0);
}

/// The example with other speeds and the search for a critical one alone.
std::string critical_scene(const std::string& speeds)
{
  std::string scene = example_scene();
  for (const auto& [key, line] :
       {std::pair{"speeds = ", "speeds = " + speeds},
        std::pair{"analyses = ", std::string("analyses = [\"critical-speed\"]")}}) {
    const std::size_t at = scene.find(key);
    scene.replace(at, scene.find('\n', at) - at, line);
  }
  return scene;
}

TEST(SquealProgram, SaysWhetherAllSpeedsAreStableOrUnstable)
{
  const Folder folder;
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const auto json_of = [&](const std::string& speeds) {
    write_text(folder.path() / "scene.toml", critical_scene(speeds));
    const Ending ending = run(folder, squeal_program + " run scene.toml --json summary.json");
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    write_text(folder.path() / "said.txt", ending.out);
    return read_text(folder.path() / "summary.json");
  };
  // The pair squeals from 13.37 rad/s on.
  const std::string unstable = json_of("{ from_rad_s = 20.0, to_rad_s = 60.0, count = 40 }");
  EXPECT_NE(unstable.find("\"critical_speed_rad_s\": null"), std::string::npos);
  EXPECT_NE(unstable.find("\"stability\": \"unstable in the whole range\""), std::string::npos);
  const std::string said = read_text(folder.path() / "said.txt");
  EXPECT_NE(said.find("none: unstable at all speeds"), std::string::npos) << said;
  EXPECT_NE(said.find("growth at 20 rad/s"), std::string::npos) << said;
  EXPECT_NE(said.find("frequency at 60 rad/s"), std::string::npos) << said;
  EXPECT_NE(
      run(folder, squeal_program + " info disc.squeal.h5").out.find("none: unstable at all speeds"),
      std::string::npos);
  const auto profile = squeal::read_results(folder.path() / "disc.squeal.h5").speed_stability;
  ASSERT_TRUE(profile);
  ASSERT_EQ(profile->unstable.size(), 1u);
  EXPECT_EQ(profile->unstable[0].from.value, 20.0);
  EXPECT_EQ(profile->unstable[0].to.value, 60.0);
  EXPECT_GT(profile->from.growth, 0.1);
  EXPECT_NEAR(profile->from.frequency_Hz, 1696.0, 5.0);

  const std::string stable = json_of("{ from_rad_s = 5.0, to_rad_s = 12.0, count = 40 }");
  EXPECT_NE(stable.find("\"critical_speed_rad_s\": null"), std::string::npos);
  EXPECT_NE(stable.find("\"stability\": \"stable in the whole range\""), std::string::npos);
  EXPECT_NE(stable.find("\"unstable_speeds_rad_s\": []"), std::string::npos);
  EXPECT_NE(read_text(folder.path() / "said.txt").find("none: stable at all speeds"),
            std::string::npos);

  const std::string lost = json_of("{ from_rad_s = 5.0, to_rad_s = 60.0, count = 40 }");
  EXPECT_NE(lost.find("\"stability\": \"lost within the range\""), std::string::npos);
  EXPECT_EQ(read_text(folder.path() / "said.txt").find("unstable from"), std::string::npos);
}

TEST(SquealProgram, CallsWhatHasNotSettledNoLimitCycle)
{
  // After a second of the four that it takes, the motion still grows by 2.8 per second.
  const Folder folder;
  const std::string scene = example_scene();
  const std::size_t analyses = scene.find("analyses = ");
  write_text(
      folder.path() / "scene.toml",
      replaced(replaced(scene, scene.substr(analyses, scene.find('\n', analyses) - analyses),
                        "analyses = [\"limit-cycle\", \"limit-cycle-direct\", \"spectrum\"]"),
               "duration_s = 6.0, initial", "duration_s = 1.0, initial"));
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending = run(folder, squeal_program + " run scene.toml --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_NE(ending.out.find("end of the transient, not settled: pad velocity"), std::string::npos)
      << ending.out;
  EXPECT_NE(ending.out.find("\ndirect limit cycle: pad velocity"), std::string::npos);
  EXPECT_EQ(ending.out.find("\nlimit cycle: "), std::string::npos) << ending.out;
  EXPECT_EQ(number_at(read_text(folder.path() / "summary.json"), "settled"), 0.0);
  EXPECT_NE(ending.out.find("\nend of the transient, not settled: pad velocity at "),
            std::string::npos)
      << "so with its spectrum: " << ending.out;
  EXPECT_EQ(ending.out.find("\npad velocity at "), std::string::npos);
}

TEST(SquealProgram, PrintsTheGrowthOfTheEigenvalueBesideThatOfAShortRun)
{
  // In 0.05 s the stable motion of the pair has not died out.
  const Folder folder;
  std::string scene = example_scene();
  for (const auto& [key, line] :
       {std::pair{"analyses = ", "analyses = [\"growth\"]"},
        std::pair{"growth = ", "growth = { speeds_rad_s = [14.1371669], duration_s = 0.05 }"}}) {
    const std::size_t at = scene.find(key);
    scene.replace(at, scene.find('\n', at) - at, line);
  }
  write_text(folder.path() / "scene.toml", scene);
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
  const Ending ending = run(folder, squeal_program + " run scene.toml --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  const squeal::Growth growth = squeal::read_results(folder.path() / "disc.squeal.h5").growth.at(0);
  ASSERT_GT(growth.eigenvalue_rate.value(), 0.1);
  ASSERT_LT(growth.rate, 0.0);
  const std::string name = "growth at 14.1372 rad/s (135 rpm)";
  const std::size_t at = ending.out.find(name + " ");
  ASSERT_NE(at, std::string::npos) << ending.out;
  EXPECT_NEAR(std::stod(ending.out.substr(at + name.size())), *growth.eigenvalue_rate, 1e-4);
  EXPECT_NE(ending.out.find(name + ", measured in a run too short"), std::string::npos)
      << ending.out;
  const std::string json = read_text(folder.path() / "summary.json");
  EXPECT_EQ(number_at(json, "growth_1_s"), *growth.eigenvalue_rate);
  EXPECT_EQ(number_at(json, "measured_growth_1_s"), growth.rate);
}

TEST(SquealProgram, SaysThatTheOscillatorAsShippedSquealsAtAllSpeeds)
{
  const Folder folder;
  write_text(folder.path() / "mass.toml",
             replaced(read_text(CHLADNI_SOURCE_DIR "/examples/oscillator/scene.toml"),
                      "\"growth\", \"limit-cycle\"]",
                      "\"critical-values\"]\n"
                      "critical = [{ parameter = \"friction\", from = 0.01, to = 1.0, "
                      "speed_rad_s = 20.0 }]"));
  const Ending ending = run(folder, squeal_program + " run mass.toml --json summary.json");
  ASSERT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_NE(ending.out.find("none: unstable at all speeds"), std::string::npos) << ending.out;
  const std::string json = read_text(folder.path() / "summary.json");
  EXPECT_NE(json.find("\"unstable_values\": [[0.1"), std::string::npos) << json;
  EXPECT_NEAR(number_at(json, "value"), 0.178571 * (1.0 + 2e-4), 2e-4);
}

TEST(SquealProgram, TellsWrongUsageFromAFailedJob)
{
  const Folder folder;
  EXPECT_EQ(run(folder, squeal_program).exit_code, 2);
  EXPECT_EQ(run(folder, squeal_program + " run").exit_code, 2);
  EXPECT_EQ(run(folder, squeal_program + " run scene.toml --outptu out").exit_code, 2);
  EXPECT_EQ(run(folder, squeal_program + " polish").exit_code, 2);
  EXPECT_EQ(run(folder, squeal_program + " run scene.toml").exit_code, 1);
  EXPECT_EQ(run(folder, squeal_program + " info nothing.h5").exit_code, 1);
}

TEST(SquealProgram, HelpsWithExamples)
{
  const Folder folder;
  for (const std::string arguments : {" --help", " run --help", " info --help"}) {
    const Ending ending = run(folder, squeal_program + arguments);
    EXPECT_EQ(ending.exit_code, 0) << arguments;
    EXPECT_NE(ending.out.find("Example"), std::string::npos) << arguments;
  }
  const Ending version = run(folder, squeal_program + " --version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("squeal ")) << version.out;
}

TEST(SquealProgram, SaysHowToMakeTheBodyThatIsMissing)
{
  const Folder folder;
  write_text(folder.path() / "scene.toml", example_scene());
  const Ending ending = run(folder, squeal_program + " run scene.toml --output out");
  EXPECT_EQ(ending.exit_code, 1);
  EXPECT_EQ(ending.err,
            "out/disc.body.h5: no such file; make it with `chladni run scene.toml --output out`, "
            "or name another one with --body\n");
  EXPECT_EQ(folder.n_files(), 1u);
}

}  // namespace
}  // namespace chladni::cli::testing
