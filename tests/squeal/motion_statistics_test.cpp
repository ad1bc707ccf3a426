#include "squeal/transient/motion_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "common/error.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "tests/squeal/turning_discs.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

constexpr double speed_of_record = 20.0;  // rad/s

/// A record of v(t) = (1 + 0.4 cos(6 speed t)) cos(2 pi 1000 t) m/s, sampled 16 times in a period.
Transient modulated(double duration)
{
  Transient run{};
  run.speed = speed_of_record;
  run.finished = true;
  run.step = 1.0 / 16e3;
  run.band = {Sampling::whole, 16e3, 8e3};
  for (int i = 0; i < static_cast<int>(16e3 * duration); ++i) {
    const double t = i * run.step, size = 1.0 + 0.4 * std::cos(6.0 * speed_of_record * t);
    run.history.t.push_back(t);
    run.history.pad_velocity.push_back(size * std::cos(2e3 * pi * t));
    run.history.pad_displacement.push_back(1e-4 + size * std::sin(2e3 * pi * t) / (2e3 * pi));
    if (i % 16 != 0) continue;
    run.envelope.t.push_back(t);
    run.envelope.pad_velocity.push_back(size);
    run.envelope.pad_displacement.push_back(1e-4 + size / (2e3 * pi));
    run.windows.t.push_back(t);
    run.windows.speed.push_back(speed_of_record);
    for (auto* N : {&run.windows.N_up_min, &run.windows.N_lo_min}) N->push_back(1000.0 - size);
    for (auto* N : {&run.windows.N_up_max, &run.windows.N_lo_max}) N->push_back(1000.0 + size);
    run.windows.open.push_back(size > 1.0 ? 0.25 : 0.0);
  }
  run.tail = run.history;
  return run;
}

TEST(MotionStatistics, AreThoseOfAModulatedOscillation)
{
  const MotionStatistics found = motion_statistics(modulated(6.0));
  EXPECT_EQ(found.n_rotations, 8);
  // A rotation takes no whole number of samples: one of 5000 is missing or too much.
  EXPECT_NEAR(found.rms_velocity, std::sqrt(0.5 * (1.0 + 0.5 * 0.4 * 0.4)), 1e-4);
  EXPECT_NEAR(found.rms_displacement, found.rms_velocity / (2e3 * pi),
              1e-4 * found.rms_displacement);
  EXPECT_NEAR(found.peak_velocity, 1.4, 1e-4);
  EXPECT_NEAR(found.N_min, 998.6, 1e-4);
  EXPECT_NEAR(found.N_max, 1001.4, 1e-4);
  EXPECT_NEAR(found.open, 0.125, 1e-3);
  EXPECT_TRUE(found.settled);
}

TEST(MotionStatistics, KnowWhichAnglesOfTheDiscAreLoud)
{
  // Each of 24 parts of a rotation is a quarter of one of the six modulations: the mean of cos over
  // it is 2 / pi or -2 / pi, that of its square 1 / 2. A part has 250 samples, its ends are one
  // off.
  const MotionStatistics found = motion_statistics(modulated(6.0));
  const double mean = 1.0 + 0.5 * 0.4 * 0.4, loud = std::sqrt(0.5 * (mean + 2.0 * 0.4 * 2.0 / pi)),
               quiet = std::sqrt(0.5 * (mean - 2.0 * 0.4 * 2.0 / pi));
  ASSERT_EQ(found.rms_over_angle.size(), 24);
  for (int part = 0; part < 24; ++part)
    EXPECT_NEAR(found.rms_over_angle[part], part % 4 == 0 || part % 4 == 3 ? loud : quiet, 4e-3);
  EXPECT_NEAR(found.modulation, (loud - quiet) / (loud + quiet), 4e-3);
}

TEST(MotionStatistics, FindTheLinesThatTheRotationMakes)
{
  const MotionStatistics found = motion_statistics(modulated(6.0));
  ASSERT_EQ(found.lines.size(), 3u);
  EXPECT_NEAR(found.lines[0].frequency_Hz, 1000.0, 1e-3);
  EXPECT_NEAR(found.lines[0].amplitude, 1.0, 1e-3);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_NEAR(found.lines[i].amplitude, 0.2, 1e-3);
    EXPECT_NEAR(std::abs(found.lines[i].rotations), 6.0, 1e-2);
  }
}

/// At 6 pi rad/s, from near its end.
Transient squealing_run(const Disc& disc, double duration)
{
  return transient(FlexibleDisc(disc, reference_options(ContactLaw::bilateral)),
                   {.speed = 6.0 * pi,
                    .duration = duration,
                    .initial_pad_displacement = 4e-4,
                    .integrator = IntegratorKind::splitting});
}

TEST(MotionStatistics, OfAnAxisymmetricDiscAreThoseOfItsLimitCycle)
{
  const Transient run = squealing_run(disc_of({kirchhoff_3(1672.13)}), 4.0);
  const LimitCycle cycle = limit_cycle(run);
  const MotionStatistics found = motion_statistics(run);
  EXPECT_TRUE(found.settled);
  // Harmonics are below 1e-3 of the fundamental; the motion still drifts by some 1e-3.
  EXPECT_NEAR(found.rms_velocity, cycle.pad_velocity / std::numbers::sqrt2,
              2e-3 * cycle.pad_velocity);
  EXPECT_NEAR(found.lines.at(0).frequency_Hz, cycle.frequency_Hz, 0.01);
  EXPECT_EQ(found.lines.size(), 1u);
  EXPECT_LT(found.modulation, 3e-3);
}

TEST(MotionStatistics, OfASplitPairHaveLinesAtTwiceItsDiameters)
{
  // A pair of three nodal diameters is the same again after a sixth of a rotation: so are the
  // coefficients, and the motion on their torus has lines at f + 6 k Omega / (2 pi) alone.
  PlatePair pair = kirchhoff_3(1672.13);
  pair.split = 4e-3;
  const MotionStatistics found = motion_statistics(squealing_run(disc_of({pair}), 12.0));
  EXPECT_TRUE(found.settled) << found.drift;
  ASSERT_GE(found.lines.size(), 3u);
  for (const MotionStatistics::Line& line : found.lines) {
    const double sixths = line.rotations / 6.0;
    EXPECT_NEAR(sixths, std::round(sixths), 0.01) << line.frequency_Hz << " " << line.amplitude;
  }
  EXPECT_GT(found.modulation, 0.03);  // ten times what is left of an axisymmetric disc
  for (int part = 0; part < 20; ++part) {
    EXPECT_NEAR(found.rms_over_angle[part + 4], found.rms_over_angle[part],
                0.02 * found.rms_velocity);
  }
}

TEST(MotionStatistics, RefuseRunsThatCannotHaveThem)
{
  EXPECT_THROW(motion_statistics(modulated(2.0)), Error) << "less than eight rotations";
  Transient run = modulated(6.0);
  run.windows.speed[run.windows.speed.size() - 10] = 19.0;
  EXPECT_THROW(motion_statistics(run), Error) << "the speed changes";
  run = modulated(6.0);
  for (double& v : run.history.pad_velocity) v *= 0.9;
  EXPECT_THROW(motion_statistics(run), Error) << "the tail has more than the history";
  run.finished = false;
  EXPECT_THROW(motion_statistics(run), Error);
}

}  // namespace
}  // namespace chladni::squeal
