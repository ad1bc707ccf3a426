#include "squeal/transient/checkpoint.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "common/error.hpp"
#include "tests/references/squeal/analytic_body.hpp"
#include "squeal/models/sliding_masses.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/common/files/scratch_folder.hpp"

namespace chladni::squeal {
namespace {

using namespace test;
using files::test::ScratchFolder, files::test::bytes_of, files::test::error_of;

/// Long enough for some looks at the clock, from where contact is lost at times.
TransientCase some_run(IntegratorKind kind)
{
  return {.speed = 6.0 * pi,
          .duration = 0.6,
          .initial_pad_displacement = 6e-4,
          .steps_per_period = 8,
          .integrator = kind};
}

struct Interruption : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Ends a run as a signal would, after half of it.
const Progress interrupt = [](double fraction) {
  if (fraction > 0.5) throw Interruption("half way");
};

void expect_equal(const History& a, const History& b)
{
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.pad_velocity, b.pad_velocity);
  EXPECT_EQ(a.N_lo, b.N_lo);
}

void expect_equal(const Transient& a, const Transient& b)
{
  expect_equal(a.history, b.history);
  expect_equal(a.tail, b.tail);
  EXPECT_EQ(a.envelope.pad_velocity, b.envelope.pad_velocity);
  EXPECT_EQ(a.windows.open, b.windows.open);
  EXPECT_EQ(a.windows.N_up_min, b.windows.N_up_min);
  EXPECT_EQ(a.snapshots.q, b.snapshots.q);
  EXPECT_EQ(a.tail_a, b.tail_a);
  EXPECT_EQ(a.events.size(), b.events.size());
  EXPECT_EQ(a.n_events, b.n_events);
  EXPECT_EQ(a.n_steps, b.n_steps);
  EXPECT_EQ(a.n_contact_evaluations, b.n_contact_evaluations);
  EXPECT_EQ(a.N_min, b.N_min);
  EXPECT_EQ(a.t_zero_force, b.t_zero_force);
}

TEST(Checkpoint, GoesOnAsIfNothingHadHappenedToTheLastBit)
{
  const Disc disc = disc_of({kirchhoff_2(), kirchhoff_3()});
  SquealOptions options = reference_options(ContactLaw::unilateral);
  options.study.sound = SoundCase{.rate_Hz = 8000};
  for (const IntegratorKind kind :
       {IntegratorKind::splitting, IntegratorKind::exponential, IntegratorKind::dormand_prince,
        IntegratorKind::generalised_alpha}) {
    SCOPED_TRACE(static_cast<int>(kind));
    const TransientCase run = some_run(kind);
    const ScratchFolder folder;
    const std::string file = folder.file("a.checkpoint.h5"), samples = folder.file("a.samples");
    WavSpool sound(folder.file("whole.wav"), folder.file("whole.samples"), 8000);
    const Transient whole = transient(FlexibleDisc(disc, options), run, {.sound = &sound});
    {
      Checkpoint checkpoint(file, {{}, "of a test"}, 0.0);
      WavSpool half(folder.file("a.wav"), samples, 8000);
      EXPECT_THROW(transient(FlexibleDisc(disc, options), run, {interrupt, &checkpoint, &half}),
                   Interruption);
    }
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.wav")));
    Checkpoint checkpoint(file, {{}, "of another test"}, 1e9);
    EXPECT_EQ(checkpoint.read().inputs, "of a test");
    WavSpool rest(folder.file("a.wav"), samples, 8000);
    double first = 1.0;
    const Progress progress = [&](double fraction) { first = std::min(first, fraction); };
    expect_equal(transient(FlexibleDisc(disc, options), run, {progress, &checkpoint, &rest}),
                 whole);
    EXPECT_GT(first, 0.3) << "began anew";
    EXPECT_EQ(bytes_of(folder.file("a.wav")), bytes_of(folder.file("whole.wav")));
    checkpoint.remove();
    rest.remove();
    EXPECT_FALSE(std::filesystem::exists(file) || std::filesystem::exists(samples));
  }
}

TEST(Checkpoint, OfAModelGoesOnAsIfNothingHadHappened)
{
  const SlidingBrake model(Oscillator{.mass = 1.0,
                                      .k_x = 1.2e7,
                                      .k_y = 4e6,
                                      .k_xy = 1e6,
                                      .d_x = 5.0,
                                      .d_y = 5.0,
                                      .contact_stiffness = 7e6,
                                      .preload = 500.0,
                                      .radius = 0.13,
                                      .friction = {.kinetic = 0.185}});
  const TransientCase run{.speed = 20.0, .duration = 1.0, .initial_pad_displacement = 1e-4};
  const ScratchFolder folder;
  const std::string file = folder.file("a.checkpoint.h5");
  Checkpoint writing(file, {}, 0.0);
  EXPECT_THROW(transient(model, run, {interrupt, &writing}), Interruption);
  Checkpoint reading(file, {}, 1e9);
  reading.read();
  expect_equal(transient(model, run, {{}, &reading}), transient(model, run));
}

TEST(Checkpoint, ThatCannotBeWrittenEndsNoRun)
{
  Checkpoint checkpoint("/proc/no_such_folder/checkpoint.h5", {}, 0.0);
  std::int64_t n = 1;
  checkpoint.keep([&](StateArchive& archive) { archive(n); });
  EXPECT_NE(checkpoint.failure().find("/proc/no_such_folder"), std::string::npos);
  EXPECT_FALSE(checkpoint.was_written());
}

TEST(Checkpoint, RefusesTheStateOfSomethingElse)
{
  const ScratchFolder folder;
  const std::string file = folder.file("a.checkpoint.h5");
  Checkpoint checkpoint(file, {}, 0.0);
  const SquealOptions options = reference_options();
  const TransientCase run = some_run(IntegratorKind::splitting);
  EXPECT_THROW(
      transient(FlexibleDisc(disc_of({kirchhoff_3()}), options), run, {interrupt, &checkpoint}),
      Interruption);
  const auto error_with = [&](const Disc& disc, IntegratorKind kind) {
    checkpoint.read();
    return error_of([&] {
      transient(FlexibleDisc(disc, options), some_run(kind), {{}, &checkpoint});
    });
  };
  const Disc same = disc_of({kirchhoff_3()}), other = disc_of({kirchhoff_3(1760.0)});
  EXPECT_NE(error_with(same, IntegratorKind::generalised_alpha).find("does not fit"),
            std::string::npos);
  EXPECT_NE(error_with(other, IntegratorKind::splitting).find("does not fit"), std::string::npos);
}

TEST(Checkpoint, WithoutTheSamplesOfItsSoundIsRefused)
{
  const ScratchFolder folder;
  SquealOptions options = reference_options();
  options.study.sound = SoundCase{.rate_Hz = 8000};
  const Disc disc = disc_of({kirchhoff_3()});
  const TransientCase run = some_run(IntegratorKind::splitting);
  Checkpoint checkpoint(folder.file("a.checkpoint.h5"), {}, 0.0);
  {
    WavSpool sound(folder.file("a.wav"), folder.file("a.samples"), 8000);
    EXPECT_THROW(transient(FlexibleDisc(disc, options), run, {interrupt, &checkpoint, &sound}),
                 Interruption);
  }
  checkpoint.read();
  std::filesystem::resize_file(folder.file("a.samples"), 8);
  WavSpool sound(folder.file("a.wav"), folder.file("a.samples"), 8000);
  EXPECT_NE(error_of([&] {
              transient(FlexibleDisc(disc, options), run, {{}, &checkpoint, &sound});
            }).find("a.samples: lacks samples"),
            std::string::npos);
}

TEST(WavSpool, LeavesNothingOfARunWithoutACheckpoint)
{
  const ScratchFolder folder;
  {
    WavSpool sound(folder.file("a.wav"), folder.file("a.samples"), 8000);
    sound.add(std::vector<float>(100000, 0.5F));
    EXPECT_TRUE(std::filesystem::exists(folder.file("a.samples")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.samples")));
}

}  // namespace
}  // namespace chladni::squeal
