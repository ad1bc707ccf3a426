#include "squeal/study/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "common/error.hpp"
#include "squeal/transient/transient_plan.hpp"

namespace chladni::squeal {
namespace {

constexpr std::array<std::string_view, 12> analyses{
    "eigenvalues",        "critical-speed",     "growth",        "transient",       "limit-cycle",
    "limit-cycle-direct", "limit-cycle-branch", "stability-map", "critical-values", "spectrum",
    "mode-sensitivity",   "rotation-stability"};

bool asks_for(const SquealOptions& options, std::string_view analysis)
{
  return std::find(options.study.analyses.begin(), options.study.analyses.end(), analysis) !=
         options.study.analyses.end();
}

void require_positive(double x, const std::string& key)
{
  if (!(x > 0.0) || !std::isfinite(x))
    throw Error(fmt::format("[squeal] {} = {}; it must be a number > 0", key, x));
}

void require_not_negative(double x, const std::string& key)
{
  if (!(x >= 0.0) || !std::isfinite(x))
    throw Error(fmt::format("[squeal] {} = {}; it must be a number >= 0", key, x));
}

void validate_pads(const SquealOptions& options)
{
  if (options.pads.empty()) throw Error("[squeal] pads: there is none; give at least one pad pair");
  for (std::size_t i = 0; i < options.pads.size(); ++i) {
    const PadPair& pad = options.pads[i];
    if (!std::isfinite(pad.angle))
      throw Error(fmt::format("[squeal] pads[{}].angle_deg is not a number", i));
    require_positive(pad.stiffness, fmt::format("pads[{}].stiffness", i));
    require_not_negative(pad.damping, fmt::format("pads[{}].damping", i));
    require_positive(pad.preload, fmt::format("pads[{}].preload", i));
    require_not_negative(pad.cubic_stiffness, fmt::format("pads[{}].cubic_stiffness", i));
    if (pad.grid && pad.grid->points < 1)
      throw Error(fmt::format("[squeal] pads[{}].grid.points = {}; it must be 1 or more", i,
                              pad.grid->points));
  }
}

void validate_modes(const ModeChoice& modes)
{
  if (modes.nodal_diameters && modes.list)
    throw Error("[squeal] use_modes: either nodal diameters or a list, not both");
  if (modes.nodal_diameters && *modes.nodal_diameters < 0)
    throw Error(fmt::format("[squeal] use_modes: {} nodal diameters; it must be 0 or more",
                            *modes.nodal_diameters));
}

void validate_speeds(const SpeedRange& speeds)
{
  require_positive(speeds.from, "speeds.from_rad_s");
  require_positive(speeds.to, "speeds.to_rad_s");
  if (speeds.to < speeds.from)
    throw Error(fmt::format("[squeal] speeds: to_rad_s = {} is below from_rad_s = {}", speeds.to,
                            speeds.from));
  if (speeds.count < 1)
    throw Error(fmt::format("[squeal] speeds.count = {}; it must be 1 or more", speeds.count));
}

void validate_transient(const SquealOptions& options)
{
  if (!options.study.transient)
    throw Error(
        "[squeal] analyses: \"transient\", \"limit-cycle\" and \"spectrum\" need `transient = { "
        "... }`");
  require_positive(options.study.transient->speed, "transient.speed_rad_s");
  require_positive(options.study.transient->duration, "transient.duration_s");
  require_positive(options.study.transient->initial_pad_displacement,
                   "transient.initial_pad_displacement");
  require_positive(options.study.transient->growth_error, "transient.growth_error");
  const std::optional<int>& steps = options.study.transient->steps_per_period;
  if (steps && *steps < steps_per_period_min)
    throw Error(fmt::format(
        "[squeal] transient.steps_per_period = {}; it must be {} or more to resolve the highest "
        "mode",
        *steps, steps_per_period_min));
}

void validate_growth(const SquealOptions& options)
{
  if (!options.study.growth || options.study.growth->speeds.empty())
    throw Error("[squeal] analyses: \"growth\" needs `growth = { speeds_rad_s = [...], ... }`");
  for (const double speed : options.study.growth->speeds)
    require_positive(speed, "growth.speeds_rad_s");
  require_positive(options.study.growth->duration, "growth.duration_s");
}

void validate_direct(const SquealOptions& options)
{
  if (!options.study.limit_cycle_direct)
    throw Error(
        "[squeal] analyses: \"limit-cycle-direct\" needs `limit_cycle_direct = { speed_rad_s = ... "
        "}`");
  require_positive(options.study.limit_cycle_direct->speed, "limit_cycle_direct.speed_rad_s");
}

void validate_map(const SquealOptions& options)
{
  if (!options.study.map)
    throw Error(
        "[squeal] analyses: \"stability-map\" needs `map = { parameter = ..., from = ..., to = "
        "..., "
        "count = ... }`");
  if (options.study.map->parameter == MapParameter::friction)
    require_not_negative(options.study.map->from, "map.from");
  else
    require_positive(options.study.map->from, "map.from");
  if (!(options.study.map->to >= options.study.map->from) || !std::isfinite(options.study.map->to))
    throw Error(fmt::format("[squeal] map.to = {}; it must be at least from = {}",
                            options.study.map->to, options.study.map->from));
  if (options.study.map->count < 1)
    throw Error(
        fmt::format("[squeal] map.count = {}; it must be 1 or more", options.study.map->count));
}

void validate_critical(const SquealOptions& options)
{
  if (options.study.critical.empty())
    throw Error(
        "[squeal] analyses: \"critical-values\" needs `critical = [{ parameter = ..., from = ..., "
        "to "
        "= ..., speed_rad_s = ... }]`");
  for (const CriticalCase& search : options.study.critical) {
    require_positive(search.from, "critical.from");
    require_positive(search.speed, "critical.speed_rad_s");
    if (!(search.to > search.from) || !std::isfinite(search.to))
      throw Error(fmt::format("[squeal] critical.to = {}; it must be above from = {}", search.to,
                              search.from));
  }
}

void validate_sound(const SquealOptions& options)
{
  if (!options.study.sound) return;
  const int rate = options.study.sound->rate_Hz;
  if (rate < 8000 || rate > 192000)
    throw Error(
        fmt::format("[squeal] wav.rate_Hz = {}; it must be 8000 to 192000, e.g. 48000", rate));
}

}  // namespace

void validate(const SquealOptions& options)
{
  require_positive(options.thickness, "thickness");
  require_not_negative(options.friction.kinetic, "friction");
  require_not_negative(options.friction.rise, "friction.static minus friction.kinetic");
  require_positive(options.friction.decay_speed, "friction.decay_speed");
  require_not_negative(options.friction.regularisation, "friction.regularisation");
  validate_modes(options.modes);
  validate_pads(options);
  for (const std::string& analysis : options.study.analyses)
    if (std::find(analyses.begin(), analyses.end(), analysis) == analyses.end())
      throw Error(fmt::format("[squeal] analyses: \"{}\" is not one of {}", analysis,
                              fmt::join(analyses, ", ")));
  if (asks_for(options, "eigenvalues") || asks_for(options, "critical-speed") ||
      asks_for(options, "stability-map") || asks_for(options, "mode-sensitivity") ||
      asks_for(options, "limit-cycle-branch") || asks_for(options, "rotation-stability"))
    validate_speeds(options.study.speeds);
  if (asks_for(options, "transient") || asks_for(options, "limit-cycle") ||
      asks_for(options, "spectrum"))
    validate_transient(options);
  if (asks_for(options, "critical-values")) validate_critical(options);
  validate_sound(options);
  if (asks_for(options, "growth")) validate_growth(options);
  if (asks_for(options, "limit-cycle-direct")) validate_direct(options);
  if (asks_for(options, "stability-map")) validate_map(options);
}

}  // namespace chladni::squeal
