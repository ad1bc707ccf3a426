// Each sweep on several threads, small enough for the thread sanitizer without optimisation.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/transient/transient.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

TEST(SweepOnThreads, OfALoopWithinALoopTakesItsThread)
{
  std::vector<char> is_own(12, 0);
  for_each_index(
      3,
      [&](int i) {
        const auto outer = std::this_thread::get_id();
        for_each_index(4, [&](int j) {
          is_own[static_cast<std::size_t>(4 * i + j)] = std::this_thread::get_id() == outer;
        });
      },
      3);
  EXPECT_EQ(is_own, std::vector<char>(12, 1));
}

TEST(SweepOnThreads, OfTheStabilityMapIsThatOnOne)
{
  SquealOptions options = reference_options();
  options.study.speeds.count = 7;
  options.study.map =
      MapCase{.parameter = MapParameter::friction, .from = 0.1, .to = 0.9, .count = 5};
  const FlexibleDisc brake(disc_of({kirchhoff_3()}), options);
  const auto on_threads = [&](unsigned n) {
    return stability_map(brake, *options.study.map, options.study.speeds, n);
  };
  const StabilityMap one = on_threads(1), three = on_threads(3);
  EXPECT_EQ(one.growth, three.growth);
  EXPECT_EQ(one.frequency_Hz, three.frequency_Hz);
}

// A rotation at 8000 1/min takes 7 ms, a hundredth of what it takes where a brake squeals.
TEST(SweepOnThreads, OfTheRotationIsThatOnOne)
{
  SquealOptions options = reference_options();
  options.study.speeds = {.from = 270.0 * pi, .to = 300.0 * pi, .count = 4};
  const RotationStability one = rotation_stability(disc_of({kirchhoff_3()}), options, 1);
  const RotationStability three = rotation_stability(disc_of({kirchhoff_3()}), options, 3);
  EXPECT_EQ(one.growth, three.growth);
  EXPECT_EQ(one.frequency_Hz, three.frequency_Hz);
}

TEST(SweepOnThreads, OfTransientsIsThatOnOne)
{
  const Disc disc = disc_of({kirchhoff_3()});
  const SquealOptions options = reference_options(ContactLaw::unilateral);
  const std::vector<double> speeds{4.0 * pi, 5.0 * pi, 6.0 * pi};
  const auto rates = [&](unsigned n_threads) {
    std::vector<double> found(speeds.size());
    const auto put = [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      found[at] = growth(FlexibleDisc(disc, options), speeds[at], 0.05).rate;
    };
    for_each_index(3, put, n_threads);
    return found;
  };
  EXPECT_EQ(rates(1), rates(3));
}

}  // namespace
}  // namespace chladni::squeal
