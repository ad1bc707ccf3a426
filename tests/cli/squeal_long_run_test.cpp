// Long runs of the program `squeal`: killed, resumed, and in constant memory.
#include <gtest/gtest.h>

#include <filesystem>

#include "mbs_export/files/body_files.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/cli/programs.hpp"
#include "tests/cli/two_mode_body.hpp"

namespace chladni::cli::testing {
namespace {

const std::string squeal_run = "'" SQUEAL_PROGRAM "' run scene.toml ";

/// The example's line that begins with `key` says `line` instead.
std::string with_line(const std::string& scene, const std::string& key, const std::string& line)
{
  const std::size_t from = scene.find("\n" + key) + 1;
  return scene.substr(0, from) + line + scene.substr(scene.find('\n', from));
}

/// A squeal of so many seconds, as sound too.
std::string long_scene(const std::string& seconds, const std::string& analyses)
{
  std::string scene = with_line(example_scene(), "analyses =", "analyses = [" + analyses + "]");
  scene = with_line(scene, "transient =",
                    "transient = { speed_rad_s = 18.85, duration_s = " + seconds +
                        ", initial_pad_displacement = 6e-4, steps_per_period = 8 }\n"
                        "wav = { rate_Hz = 8000 }");
  return scene;
}

void prepare(const Folder& folder, const std::string& scene)
{
  write_text(folder.path() / "scene.toml", scene);
  mbs_export::write_body(folder.path() / "disc.body.h5", kirchhoff_body());
}

/// Kills the run as soon as the transient has begun.
Ending run_and_kill(const Folder& folder)
{
  return run(folder, "{ " + squeal_run +
                         "& while kill -0 $! && ! ls *.wav.tmp-* >/dev/null 2>&1; do "
                         "sleep 0.02; done; kill -9 $!; wait $!; }");
}

TEST(LongRun, ThatWasKilledKeepsItsFinishedAnalyses)
{
  const std::string scene = long_scene("60.0", "\"eigenvalues\", \"limit-cycle\"");
  const Folder whole, killed;
  prepare(whole, scene);
  prepare(killed, scene);
  ASSERT_EQ(run(whole, squeal_run).exit_code, 0);
  EXPECT_EQ(run_and_kill(killed).exit_code, 137);
  const squeal::SquealResults left = squeal::read_results(killed.path() / "disc.squeal.h5");
  EXPECT_TRUE(left.eigenvalues) << "what was finished is kept";
  EXPECT_EQ(left.missing, (std::vector<std::string>{"transient", "limit-cycle"}));
  EXPECT_NE(run(killed, "'" SQUEAL_PROGRAM "' info disc.squeal.h5")
                .out.find("missing: transient, limit-cycle; the run was interrupted"),
            std::string::npos);

  write_text(killed.path() / "scene.toml", replaced(scene, "friction = 0.6", "friction = 0.5"));
  const Ending refused = run(killed, squeal_run + "--resume");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("cannot be resumed, since the scene has changed: squeal.friction"),
            std::string::npos)
      << refused.err;

  write_text(killed.path() / "scene.toml", scene);
  const Ending resumed = run(killed, squeal_run + "--resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  const squeal::SquealResults a = squeal::read_results(whole.path() / "disc.squeal.h5"),
                              b = squeal::read_results(killed.path() / "disc.squeal.h5");
  EXPECT_TRUE(b.missing.empty());
  EXPECT_EQ(b.transient->history.pad_velocity, a.transient->history.pad_velocity);
  EXPECT_EQ(b.limit_cycle->amplitude, a.limit_cycle->amplitude);
  EXPECT_TRUE(read_text(whole.path() / "disc.wav") == read_text(killed.path() / "disc.wav"));
  EXPECT_EQ(killed.n_files(), whole.n_files()) << "unfinished files are removed";
}

TEST(LongRun, OfAnotherBodyIsNotResumed)
{
  const Folder folder;
  prepare(folder, long_scene("60.0", "\"transient\""));
  EXPECT_EQ(run_and_kill(folder).exit_code, 137);
  mbs_export::ModalBody other = kirchhoff_body();
  other.omega *= 1.001;
  mbs_export::write_body(folder.path() / "disc.body.h5", other);
  const Ending refused = run(folder, squeal_run + "--resume");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("cannot be resumed: it was made from squeal"), std::string::npos)
      << refused.err;
}

TEST(LongRun, BeyondWhatAWavHoldsIsRefusedBeforeItBegins)
{
  const Folder folder;
  prepare(folder, long_scene("1e6", "\"eigenvalues\", \"transient\""));
  const Ending refused = run(folder, squeal_run);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("wav.rate_Hz = 8000: a WAV file holds up to 4 GiB, 268435 s"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "disc.squeal.h5"));
}

TEST(LongRun, RefusesTheOptionsThatAreGone)
{
  const Folder folder;
  prepare(folder, long_scene("0.1", "\"transient\""));
  const Ending refused = run(folder, squeal_run + "--checkpoint 10");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--checkpoint is gone"), std::string::npos) << refused.err;
}

TEST(LongRun, WithNothingToResumeSaysSo)
{
  const Folder folder;
  prepare(folder, long_scene("0.1", "\"transient\""));
  const Ending refused = run(folder, squeal_run + "--resume");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("no run was interrupted here"), std::string::npos) << refused.err;
}

#ifdef CHLADNI_SANITIZED
TEST(LongRun, TakesNoMoreMemoryThanAShorterOne)
{
  GTEST_SKIP() << "the sanitizer keeps what was freed";
}
#else
double peak_of(const std::string& seconds)
{
  const Folder folder;
  prepare(folder, long_scene(seconds, "\"transient\""));
  EXPECT_EQ(run(folder, squeal_run + "--json summary.json").exit_code, 0);
  return number_at(read_text(folder.path() / "summary.json"), "peak_MiB");
}

TEST(LongRun, TakesNoMoreMemoryThanAShorterOne)
{
  // From 50 s on there are as many points of the envelope as there may be.
  const double peak = peak_of("50.0");
  const double long_peak = peak_of("500.0");
  RecordProperty("MiB", std::to_string(peak));
  EXPECT_LT(long_peak, 1.1 * peak);
}
#endif

}  // namespace
}  // namespace chladni::cli::testing
