#include "squeal/study/study.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/error.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal {
namespace {

using namespace test;

SquealOptions complete_options()
{
  SquealOptions options = reference_options();
  options.study.analyses = {
      "eigenvalues",        "critical-speed",     "growth",        "transient",       "limit-cycle",
      "limit-cycle-direct", "limit-cycle-branch", "stability-map", "critical-values", "stability"};
  options.study.transient =
      TransientCase{.speed = 10.0, .duration = 1.0, .initial_pad_displacement = 1e-8};
  options.study.growth = GrowthCase{.speeds = {10.0}, .duration = 1.0};
  options.study.map =
      MapCase{.parameter = MapParameter::preload, .from = 100.0, .to = 200.0, .count = 3};
  options.study.limit_cycle_direct = DirectCase{.speed = 10.0};
  options.study.critical = {
      {.parameter = MapParameter::preload, .from = 100.0, .to = 200.0, .speed = 10.0}};
  options.study.stability = StabilityCase{.over = MapParameter::preload,
                                          .from = 100.0,
                                          .to = 200.0,
                                          .count = 2,
                                          .speed = 10.0,
                                          .band = FrequencyBand{0.0, 1000.0}};
  options.study.sound = SoundCase{48000};
  return options;
}

/// The error after one change to good options must name the key.
void expect_named(const std::string& key, const std::function<void(SquealOptions&)>& change)
{
  SquealOptions options = complete_options();
  change(options);
  try {
    validate(FlexibleDisc(disc_of({kirchhoff_3()}), options), options.study);
    ADD_FAILURE() << "no error for " << key;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
  }
}

TEST(Validate, AcceptsTheReferenceOptions)
{
  EXPECT_NO_THROW(validate(FlexibleDisc(disc_of({kirchhoff_3()}), complete_options()),
                           complete_options().study));
  SquealOptions frictionless = complete_options();
  frictionless.friction.kinetic = 0.0;
  EXPECT_NO_THROW(
      validate(FlexibleDisc(disc_of({kirchhoff_3()}), frictionless), frictionless.study));
}

TEST(Validate, NamesTheKeyThatMakesNoSense)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_named("friction", [](auto& o) { o.friction.kinetic = -0.1; });
  expect_named("friction", [&](auto& o) { o.friction.kinetic = nan; });
  expect_named("thickness", [](auto& o) { o.thickness = 0.0; });
  expect_named("pads", [](auto& o) { o.pads.clear(); });
  expect_named("pads[0].stiffness", [](auto& o) { o.pads[0].stiffness = 0.0; });
  expect_named("pads[0].damping", [](auto& o) { o.pads[0].damping = -1.0; });
  expect_named("pads[0].preload", [](auto& o) { o.pads[0].preload = 0.0; });
  expect_named("use_modes", [](auto& o) { o.modes.nodal_diameters = -1; });
  expect_named("not both", [](auto& o) { o.modes = {.nodal_diameters = 3, .list = {{1}}}; });
  expect_named("friction.static", [](auto& o) { o.friction.rise = -0.7; });
  expect_named("friction.decay_speed", [](auto& o) { o.friction.decay_speed = 0.0; });
  expect_named("friction.regularisation", [](auto& o) { o.friction.regularisation = -1.0; });
  expect_named("pads[0].friction", [](auto& o) { o.pads[0].friction = FrictionLaw{-0.1}; });
  expect_named("pads[0].angle_deg", [&](auto& o) { o.pads[0].angle = nan; });
  expect_named("pads[0].cubic_stiffness", [](auto& o) { o.pads[0].cubic_stiffness = -1.0; });
  expect_named("pads[0].grid.points",
               [](auto& o) { o.pads[0].grid = PadGrid{.sector = 0.5, .points = 0}; });
}

TEST(Validate, NamesWhatAnAnalysisLacks)
{
  expect_named("eigenvalue", [](auto& o) { o.study.analyses = {"eigenvalue"}; });
  expect_named("from_rad_s", [](auto& o) { o.study.speeds.from = 0.0; });
  expect_named("to_rad_s", [](auto& o) { o.study.speeds.to = 1.0; });
  expect_named("count", [](auto& o) { o.study.speeds.count = 0; });
  expect_named("transient", [](auto& o) { o.study.transient.reset(); });
  expect_named("transient.speed", [](auto& o) { o.study.transient->speed = 0.0; });
  expect_named("transient.duration", [](auto& o) { o.study.transient->duration = -1.0; });
  expect_named("initial_pad", [](auto& o) { o.study.transient->initial_pad_displacement = 0.0; });
  expect_named("steps_per_period", [](auto& o) { o.study.transient->steps_per_period = 4; });
  expect_named("growth", [](auto& o) { o.study.growth.reset(); });
  expect_named("growth.speeds", [](auto& o) { o.study.growth->speeds = {10.0, 0.0}; });
  expect_named("limit_cycle_direct", [](auto& o) { o.study.limit_cycle_direct.reset(); });
  expect_named("limit_cycle_direct.speed",
               [](auto& o) { o.study.limit_cycle_direct->speed = 0.0; });
  expect_named("map", [](auto& o) { o.study.map.reset(); });
  expect_named("map.from", [](auto& o) { o.study.map->from = 0.0; });
  expect_named("map.to", [](auto& o) { o.study.map->to = 50.0; });
  expect_named("map.count", [](auto& o) { o.study.map->count = 0; });
  expect_named("growth.duration", [](auto& o) { o.study.growth->duration = 0.0; });
  expect_named("growth_error", [](auto& o) { o.study.transient->growth_error = 0.0; });
  expect_named("critical", [](auto& o) { o.study.critical.clear(); });
  expect_named("critical.from", [](auto& o) { o.study.critical[0].from = 0.0; });
  expect_named("critical.speed_rad_s", [](auto& o) { o.study.critical[0].speed = 0.0; });
  expect_named("critical.to", [](auto& o) { o.study.critical[0].to = 100.0; });
  expect_named("stability.from", [](auto& o) { o.study.stability->from = 0.0; });
  expect_named("stability: to", [](auto& o) { o.study.stability->to = 100.0; });
  expect_named("stability.count", [](auto& o) { o.study.stability->count = 1; });
  expect_named("stability.speed_rad_s", [](auto& o) { o.study.stability->speed = 0.0; });
  expect_named("stability.band_Hz", [](auto& o) { o.study.stability->band->from_Hz = -1.0; });
  expect_named("stability.band_Hz", [](auto& o) { o.study.stability->band->to_Hz = 0.0; });
  expect_named("speeds.count", [](auto& o) {
    o.study.stability.reset();
    o.study.speeds.count = 1;
  });
  for (const int rate : {7999, 192001})
    expect_named("wav.rate_Hz", [rate](auto& o) { o.study.sound = SoundCase{rate}; });
  expect_named("a WAV file holds up to 4 GiB", [](auto& o) { o.study.transient->duration = 1e5; });
}

}  // namespace
}  // namespace chladni::squeal
