#include "squeal/transient/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "squeal/results/squeal_results.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::squeal {
namespace {

using std::numbers::pi;

constexpr double rate_Hz = 20000.0, duration = 2.0;

/// A run-up from 10 to 30 rad/s: a line of 1700 Hz that grows, and one of the order 400.
Transient run_up()
{
  Transient run{};
  run.band = {Sampling::whole, rate_Hz, 0.5 * rate_Hz};
  run.speed = 30.0;
  const auto n = static_cast<int>(duration * rate_Hz);
  for (int i = 0; i < n; ++i) {
    const double t = i / rate_Hz;
    const double angle = 10.0 * t + 0.5 * 10.0 * t * t;
    run.history.t.push_back(t);
    run.history.pad_velocity.push_back(1e-3 * std::exp(2.0 * t) * std::sin(2.0 * pi * 1700.0 * t) +
                                       5e-4 * std::sin(400.0 * angle));
  }
  for (int i = 0; i <= 100; ++i) {
    run.windows.t.push_back(0.02 * i);
    run.windows.speed.push_back(10.0 + 10.0 * 0.02 * i);
  }
  return run;
}

TEST(Spectrogram, FollowsOneLineInTimeAndAnotherWithTheRotation)
{
  const Spectrogram found = spectrogram(run_up());
  ASSERT_EQ(found.t.size(), found.line_Hz.rows());
  EXPECT_GT(found.t.size(), 100);
  EXPECT_EQ(found.amplitude.rows(), found.t.size());
  EXPECT_EQ(found.amplitude.cols(), found.frequency_Hz.size());
  for (Eigen::Index k = 0; k < found.t.size(); k += 7) {
    const double t = found.t[k];
    EXPECT_NEAR(found.speed[k], 10.0 + 10.0 * t, 1e-9);
    EXPECT_NEAR(found.line_Hz(k, 0), 1700.0, 1.0);
    // The growth within a window of 0.04 s.
    EXPECT_NEAR(found.line_amplitude(k, 0) / (1e-3 * std::exp(2.0 * t)), 1.0, 0.01);
    // The line of the rotation crosses no other: 637 to 1910 Hz; near the first it is hidden.
    if (std::abs(400.0 * found.speed[k] / (2.0 * pi) - 1700.0) < 200.0) continue;
    EXPECT_NEAR(2.0 * pi * found.line_Hz(k, 1) / found.speed[k], 400.0, 4.0) << t;
    EXPECT_GE(found.envelope[k], 0.99e-3 * std::exp(2.0 * (t - 0.02)));
  }
}

TEST(Spectrogram, NeedsAHistory)
{
  Transient run = run_up();
  run.history.pad_velocity.resize(100);
  EXPECT_NE(files::test::error_of([&] { spectrogram(run); }).find("the history has 100 samples"),
            std::string::npos);
}

TEST(Spectrogram, ComesBackFromItsFile)
{
  SquealResults results;
  results.spectrogram = spectrogram(run_up());
  const files::test::ScratchFolder folder;
  write_results(folder.file("a.squeal.h5"), results, {});
  const Spectrogram again = read_results(folder.file("a.squeal.h5")).spectrogram.value();
  EXPECT_EQ(again.amplitude, results.spectrogram->amplitude);
  EXPECT_EQ(again.line_Hz, results.spectrogram->line_Hz);
  EXPECT_EQ(again.speed, results.spectrogram->speed);
}

}  // namespace
}  // namespace chladni::squeal
