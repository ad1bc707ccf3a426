#include "scene/squeal_tables.hpp"

#include <fmt/format.h>

#include <numbers>

namespace chladni::scene {
namespace {

using squeal::ContactLaw;
using squeal::IntegratorKind;

/// Needs of the analyses beyond the key of the same name.
void check_needs(const Table& squeal, const std::vector<std::string>& analyses)
{
  // The limit cycle is looked for at the speed of the transient.
  if (contains(analyses, "limit-cycle") && !squeal.has("transient")) {
    squeal.refuse("analyses", "\"limit-cycle\" needs the speed in the key transient");
  }
  if (contains(analyses, "limit-cycle-direct") && !squeal.has("limit_cycle_direct") &&
      !squeal.has("transient")) {
    squeal.refuse("analyses",
                  "\"limit-cycle-direct\" needs the key limit_cycle_direct, or else the speed in "
                  "the key transient");
  }
  if (contains(analyses, "stability-map") && !squeal.has("map")) {
    squeal.refuse("analyses", "\"stability-map\" needs the key map");
  }
  if (contains(analyses, "critical-values") && !squeal.has("critical")) {
    squeal.refuse("analyses", "\"critical-values\" needs the key critical");
  }
  if (contains(analyses, "spectrum") && !squeal.has("transient")) {
    squeal.refuse("analyses", "\"spectrum\" needs the key transient");
  }
  if (squeal.has("wav") && !squeal.has("transient")) {
    squeal.refuse("wav", "needs the key transient");
  }
  for (const char* needed : {"transient", "growth"}) {
    if (contains(analyses, needed) && !squeal.has(needed)) {
      squeal.refuse("analyses", fmt::format("\"{0}\" needs the key {0}", needed));
    }
  }
}

/// Times rise; the first speed is that at which the transient begins.
std::vector<squeal::SpeedPoint> read_speed_program(const Table& transient, double first_speed)
{
  std::vector<squeal::SpeedPoint> points{{.time = 0.0, .speed = first_speed}};
  for (const Table& row : transient.tables("speed_program")) {
    points.push_back({.time = row.number("t_s", {.above = points.back().time, .unit = "s"}),
                      .speed = row.number("speed_rad_s")});
  }
  if (points.size() == 1) transient.refuse("speed_program", "must hold at least one point");
  return points;
}

}  // namespace

/// The keys of one end of the range.
struct SpeedKeys {
  std::string_view rad_s, rpm, km_h;
};

/// In any unit, rad/s.
double read_speed(const Table& speeds, const SpeedKeys& keys, double least)
{
  const std::string_view key = speeds.only_one_of({keys.rad_s, keys.rpm, keys.km_h});
  double unit = 1.0;
  if (key == keys.rpm) unit = std::numbers::pi / 30.0;
  if (key == keys.km_h) unit = 1.0 / (3.6 * speeds.number("wheel_radius"));
  return unit * speeds.number(key, {.at_least = least / unit});
}

squeal::SpeedRange read_speeds(const Table& squeal)
{
  const Table speeds = squeal.table("speeds");
  const double from = read_speed(speeds, {"from_rad_s", "from_rpm", "from_km_h"}, 0.0);
  const double to = read_speed(speeds, {"to_rad_s", "to_rpm", "to_km_h"}, from);
  const int least = to > from ? 2 : 1;
  return {.from = from,
          .to = to,
          .count = speeds.integer("count", {.at_least = static_cast<double>(least)}),
          .wheel_radius = speeds.has("wheel_radius") ? std::optional(speeds.number("wheel_radius"))
                                                     : std::nullopt};
}

squeal::FrictionLaw read_friction(const Table& squeal)
{
  if (!squeal.is_table("friction")) return {.kinetic = squeal.number("friction")};
  const Table table = squeal.table("friction");
  squeal::FrictionLaw law{.kinetic = table.number("kinetic")};
  if (table.has("static")) {
    law.rise = table.number("static", {.at_least = law.kinetic, .unit = "kinetic"}) - law.kinetic;
    law.decay_speed = table.number("decay_speed");
  }
  if (table.has("regularisation")) {
    law.regularisation = table.number("regularisation");
  }
  return law;
}

squeal::ContactLaw read_contact(const Table& squeal)
{
  if (!squeal.has("contact")) return ContactLaw::unilateral;
  return squeal.choice<ContactLaw>("contact", {{"unilateral", ContactLaw::unilateral},
                                               {"bilateral", ContactLaw::bilateral},
                                               {"signed", ContactLaw::signed_force}});
}

squeal::PadSpring read_pad_spring(const Table& pad)
{
  squeal::PadSpring spring{.linear = pad.number("stiffness")};
  if (pad.has("cubic_stiffness")) {
    spring.cubic = pad.number("cubic_stiffness");
  }
  return spring;
}

std::vector<std::string> read_analyses(const Table& squeal, const std::vector<std::string>& known)
{
  std::vector<std::string> analyses = squeal.texts("analyses");
  if (analyses.empty()) {
    squeal.refuse("analyses", "must name at least one of " + quoted_list(known));
  }
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    if (!contains(known, analyses[i])) {
      squeal.refuse_element("analyses", i, "must be one of " + quoted_list(known));
    }
  }
  check_needs(squeal, analyses);
  return analyses;
}

std::optional<squeal::TransientCase> read_transient(const Table& squeal)
{
  if (!squeal.has("transient")) return std::nullopt;
  const Table table = squeal.table("transient");
  squeal::TransientCase transient{
      .speed = table.number("speed_rad_s"),
      .duration = table.number("duration_s"),
      .initial_pad_displacement = table.number("initial_pad_displacement")};
  if (table.has("steps_per_period")) {
    transient.steps_per_period = table.integer("steps_per_period");
  }
  if (table.has("integrator")) {
    transient.integrator = table.choice<IntegratorKind>(
        "integrator", {{"auto", IntegratorKind::automatic},
                       {"splitting", IntegratorKind::splitting},
                       {"exponential", IntegratorKind::exponential},
                       {"dormand-prince", IntegratorKind::dormand_prince},
                       {"generalised-alpha", IntegratorKind::generalised_alpha}});
  }
  if (table.has("growth_error_1_s")) {
    transient.growth_error = table.number("growth_error_1_s");
  }
  if (table.has("speed_program")) {
    transient.speed_program = read_speed_program(table, transient.speed);
  }
  return transient;
}

std::optional<squeal::GrowthCase> read_growth(const Table& squeal)
{
  if (!squeal.has("growth")) return std::nullopt;
  const Table table = squeal.table("growth");
  squeal::GrowthCase growth{.speeds = table.numbers("speeds_rad_s"),
                            .duration = table.number("duration_s")};
  if (growth.speeds.empty()) table.refuse("speeds_rad_s", "must hold at least one speed");
  return growth;
}

}  // namespace chladni::scene
