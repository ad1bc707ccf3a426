#include "squeal/stability/stability_map.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "squeal/stability/eigenvalues.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

Disc reference_disc()
{
  return disc_of({kirchhoff_3()});
}

SquealOptions map_options(const MapCase& map)
{
  SquealOptions options = reference_options();
  options.study.map = map;
  return options;
}

TEST(StabilityMap, HoldsTheLeastStableEigenvalueOfEachPoint)
{
  const struct {
    MapCase map;
    void (*set)(SquealOptions&, double);
  } cases[] = {
      {{MapParameter::friction, 0.1, 0.9, 3}, [](auto& o, double x) { o.friction.kinetic = x; }},
      {{MapParameter::preload, 500.0, 4e3, 3}, [](auto& o, double x) { o.pads[0].preload = x; }},
      {{MapParameter::stiffness, 1e6, 9e6, 3}, [](auto& o, double x) { o.pads[0].stiffness = x; }}};
  for (const auto& c : cases) {
    const StabilityMap map = stability_map(FlexibleDisc(reference_disc(), reference_options()),
                                           c.map, reference_options().study.speeds);
    ASSERT_EQ(map.growth.rows(), 3);
    ASSERT_EQ(map.growth.cols(), 60);
    EXPECT_EQ(map.parameter, c.map.parameter.name);
    for (Eigen::Index i = 0; i < 3; ++i)
      for (const Eigen::Index j : {0, 17, 59}) {
        SquealOptions point = reference_options();
        c.set(point, map.values[i]);
        const auto lambda = least_stable_eigenvalue(
            state_matrix(inertial_disc(reference_disc()), point, map.speeds[j]));
        EXPECT_EQ(map.growth(i, j), lambda.real());
        EXPECT_EQ(map.frequency_Hz(i, j), lambda.imag() / (2.0 * pi));
      }
  }
}

TEST(StabilityMap, TurnsUnstableAtTheCriticalSpeedOfEachFriction)
{
  const SquealOptions options = map_options({MapParameter::friction, 0.4, 0.8, 5});
  const FlexibleDisc brake(reference_disc(), options);
  const StabilityMap map = stability_map(brake, *options.study.map, options.study.speeds);
  for (Eigen::Index i = 0; i < map.values.size(); ++i) {
    const auto critical = critical_speed(stability_over_speed(
        state_matrix_at(*brake.with(MapParameter::friction, map.values[i])), options.study.speeds));
    ASSERT_TRUE(critical);
    for (Eigen::Index j = 0; j < map.speeds.size(); ++j)
      EXPECT_EQ(map.growth(i, j) > 0.0, map.speeds[j] > critical->speed);
  }
}

TEST(StabilityMap, IsTheSameInEveryRunAndFast)
{
  SquealOptions options = map_options({MapParameter::stiffness, 1e6, 9e6, 100});
  options.study.speeds.count = 100;
  const FlexibleDisc brake(reference_disc(), options);
  const auto begin = std::chrono::steady_clock::now();
  const StabilityMap map = stability_map(brake, *options.study.map, options.study.speeds);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(map.growth, stability_map(brake, *options.study.map, options.study.speeds).growth);
#ifdef NDEBUG
  EXPECT_LT(time.count(), 10.0);  // a promise to users; it takes a fraction of a second
#endif
  RecordProperty("seconds", std::to_string(time.count()));
}

}  // namespace
}  // namespace chladni::squeal
