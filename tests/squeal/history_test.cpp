#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "squeal/motion/splitting.hpp"
#include "squeal/transient/recorder.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

/// A squeal of 1.7 kHz that is at its limit cycle from the begin, 14 samples in a millisecond.
TransientCase squealing(double duration)
{
  return {.speed = 6.0 * pi,
          .duration = duration,
          .initial_pad_displacement = 6e-4,
          .steps_per_period = 8,
          .integrator = IntegratorKind::exponential};
}

double largest(const std::vector<double>& x)
{
  return std::abs(*std::ranges::max_element(x, {}, [](double y) { return std::abs(y); }));
}

TEST(History, OfAShortRunIsEverySample)
{
  const Transient run =
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), squealing(0.1));
  EXPECT_EQ(run.band.sampling, Sampling::whole);
  EXPECT_NEAR(run.band.rate_Hz, 1.0 / run.step, 1e-6);
  ASSERT_GE(run.history.t.size(), run.tail.t.size());
  EXPECT_EQ(run.history.pad_velocity.back(), run.tail.pad_velocity.back());
}

TEST(History, HoldsTheSquealWhereItsBandDoes)
{
  const Transient run =
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), squealing(29.0));
  ASSERT_EQ(run.band.sampling, Sampling::band_limited);
  ASSERT_GT(run.band.to_Hz, 1750.0);
  ASSERT_LE(run.history.t.size(), 200000u);
  // Harmonics of the squeal, 1e-3 of it, are taken out; the ends lack samples beyond them.
  std::size_t n_compared = 0, j = 0;
  for (std::size_t i = 0; i + 60 < run.history.t.size(); ++i) {
    while (j < run.tail.t.size() && run.tail.t[j] < run.history.t[i] - 0.1 * run.step) ++j;
    if (j == run.tail.t.size() || std::abs(run.tail.t[j] - run.history.t[i]) > 0.1 * run.step)
      continue;
    ++n_compared;
    ASSERT_NEAR(run.history.pad_velocity[i], run.tail.pad_velocity[j],
                3e-3 * run.envelope.pad_velocity.back());
  }
  EXPECT_GT(n_compared, 100u);
}

TEST(History, OfALongRunHoldsNoSquealThatLooksLikeALowerTone)
{
  const Transient run =
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), reference_options()), squealing(75.0));
  ASSERT_EQ(run.band.sampling, Sampling::band_limited);
  ASSERT_LT(0.5 * run.band.rate_Hz, 1600.0);  // the squeal would be folded down
  const std::vector<double>& v = run.history.pad_velocity;
  const std::vector<double> inside(v.begin() + 60, v.end() - 60);
  EXPECT_LT(largest(inside), 1e-3 * run.envelope.pad_velocity.back());
  EXPECT_GT(largest(run.tail.pad_velocity), 0.99 * run.envelope.pad_velocity.back());
}

TEST(RecordingPlan, OfALongRunKeepsTheFineWindowsOfItsGrowthAndHasLimits)
{
  const FrequencyRange omega{.lowest = 2.0 * pi * 10.0, .highest = 2.0 * pi * 1000.0};
  const RecordingPlan one = recording_plan(squealing(1.0), omega, 20);
  const RecordingPlan many = recording_plan(squealing(1e5), omega, 20);
  EXPECT_EQ(many.window, one.window);
  EXPECT_NEAR(double(one.window) * one.step, 0.4, one.step) << "four periods of the lowest";
  const std::int64_t n_behind = many.n_steps - many.n_fine_windows * many.window;
  ASSERT_GT(n_behind, 0);
  EXPECT_LE(many.n_fine_windows + n_behind / many.late_window, 20000);
  const RecordingPlan low =
      recording_plan(squealing(1e4), {.lowest = 1e-3, .highest = omega.highest}, 20);
  EXPECT_LE(low.n_tail, 300000);
}

TEST(RecordingPlan, RefusesAFrequencyThatNoBrakeHas)
{
  const FrequencyRange gigahertz{.lowest = 2.0 * pi * 1e6, .highest = 2.0 * pi * 1e9};
  const auto error_of = [](double duration, const FrequencyRange& omega) -> std::string {
    try {
      recording_plan(squealing(duration), omega, 20);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string error = error_of(0.1, gigahertz);  // 2e9 steps
  EXPECT_NE(error.find("is the density in kg/m^3"), std::string::npos) << error;
  EXPECT_EQ(error_of(1e-4, gigahertz), "") << "a short run of a body of other units";
  const std::string long_run =
      error_of(1e8, {.lowest = 2.0 * pi * 10.0, .highest = 2.0 * pi * 1e3});
  EXPECT_NE(long_run.find("hours: 6e+02 or more"), std::string::npos) << long_run;
}

TEST(Windows, OfALongRunBecomeLonger)
{
  RecordingPlan plan{.step = 1e-3,
                     .n_steps = 1000,
                     .window = 10,
                     .n_fine_windows = 20,
                     .late_window = 100,
                     .history = decimation_to(1000, 1000),
                     .n_tail = 10};
  Recorder recorder(plan, 0.0);
  for (std::int64_t i = 0; i < plan.n_steps; ++i) {
    const std::vector<ContactResult<double>> contacts(1);
    recorder.add({.i = i, .t = double(i) * plan.step, .speed = 1.0, .contacts = contacts});
  }
  const std::vector<double>& t = recorder.transient().windows.t;
  ASSERT_EQ(t.size(), 20u + 8u);
  EXPECT_NEAR(t[19] - t[18], 0.010, 1e-12);
  EXPECT_NEAR(t[21] - t[20], 0.100, 1e-12);
}

TEST(Windows, SayWhatEverySampleDid)
{
  TransientCase run = squealing(0.3);
  run.integrator = IntegratorKind::splitting;
  run.speed_program = {{0.0, 6.0 * pi}, {0.3, 4.0 * pi}};
  const SquealOptions options = reference_options(ContactLaw::unilateral);
  const Transient result = transient(FlexibleDisc(disc_of({kirchhoff_3()}), options), run);
  const Windows& windows = result.windows;
  ASSERT_GT(windows.t.size(), 50u);
  EXPECT_EQ(std::ranges::max(windows.N_up_max), std::ranges::max(result.history.N_up));
  EXPECT_EQ(std::ranges::min(windows.N_lo_min), std::ranges::min(result.history.N_lo));
  EXPECT_EQ(std::ranges::min(windows.slip_speed_min), std::ranges::min(result.history.slip_speed));
  double n_open = 0.0, n = 0.0;
  for (std::size_t i = 0, j = 0; i < windows.t.size(); ++i) {
    EXPECT_DOUBLE_EQ(windows.speed[i], turn_at(run, windows.t[i]).speed);
    const double end = i + 1 < windows.t.size() ? windows.t[i + 1] - 0.5 * result.step : 1.0;
    for (n_open = n = 0.0; j < result.history.t.size() && result.history.t[j] < end; ++j, ++n)
      if (result.history.N_up[j] <= 0.0 || result.history.N_lo[j] <= 0.0) ++n_open;
    EXPECT_DOUBLE_EQ(windows.open[i], n_open / n) << i;
  }
  EXPECT_GT(largest(windows.open), 0.0) << "contact is lost at times";
}

TEST(PadDisplacement, IsThatOfThePlateUnderThePad)
{
  // z - h / 2 = w + h / 2 (s - 1) with the deflection w and the slopes of the middle surface: the
  // normals of a plate stay as long as they are.
  SquealOptions options = reference_options();
  options.thickness = 0.022;
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  const FlexibleDisc brake(disc, options);
  const Transient run = transient(brake, squealing(0.05));
  const auto states = states_of(brake, squealing(0.05), run.step, run.history.t.size());
  double most = 0.0;
  for (std::size_t i = 0; i < run.history.t.size(); ++i) {
    const Shapes ring = shapes_at(disc, options.pads[0].angle - 6.0 * pi * run.history.t[i]);
    const Eigen::VectorXd& q = states[i].q;
    const double w = ring.W.dot(q), g_r = ring.W_r.dot(q), g_t = ring.W_t.dot(q);
    const double lift = 0.5 * options.thickness * (std::sqrt(1.0 + g_r * g_r + g_t * g_t) - 1.0);
    most = std::max(most, lift);
    ASSERT_NEAR(run.history.pad_displacement[i], w + lift, 1e-12);  // 1e-9 of the amplitude
  }
  EXPECT_GT(most, 1e-7) << "the normals lean";
}

}  // namespace
}  // namespace chladni::squeal
