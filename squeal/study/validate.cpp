#include "squeal/study/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "common/error.hpp"
#include "squeal/analysis_options.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/stability/unstable_modes.hpp"
#include "squeal/transient/transient_plan.hpp"

namespace chladni::squeal {
namespace {

bool asks_for(const StudyOptions& study, std::string_view analysis)
{
  return std::ranges::find(study.analyses, analysis) != study.analyses.end();
}

/// Whether an analysis that is asked for needs this key of [squeal].
bool needs(const StudyOptions& study, std::string_view key)
{
  return std::ranges::any_of(analyses, [&](const Analysis& analysis) {
    return analysis.key == key && asks_for(study, analysis.name);
  });
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

void require_value_of(MapParameter parameter, double x, const std::string& key)
{
  const ParameterRow* const row = find_parameter(parameter.name);
  if (!row) throw Error(fmt::format("[squeal] \"{}\" is no parameter", key_of(parameter)));
  if (row->may_be_zero)
    require_not_negative(x, key);
  else
    require_positive(x, key);
}

/// The brake has what is to vary.
void require_parameters(const Brake& brake, const StudyOptions& study)
{
  if (needs(study, "map")) brake.with(study.map->parameter, study.map->to);
  if (needs(study, "critical"))
    for (const CriticalCase& search : study.critical) brake.with(search.parameter, search.to);
  const StabilityCase table = stability_case(study);
  if (asks_for(study, "stability") && table.over) brake.with(*table.over, table.to);
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
    if (pad.grid && pad.grid->points < 1) {
      throw Error(fmt::format("[squeal] pads[{}].grid.points = {}; it must be 1 or more", i,
                              pad.grid->points));
    }
  }
}

void validate_modes(const ModeChoice& modes)
{
  if (modes.nodal_diameters && modes.list)
    throw Error("[squeal] use_modes: either nodal diameters or a list, not both");
  if (modes.nodal_diameters && *modes.nodal_diameters < 0) {
    throw Error(fmt::format("[squeal] use_modes: {} nodal diameters; it must be 0 or more",
                            *modes.nodal_diameters));
  }
}

void validate_speeds(const SpeedRange& speeds)
{
  require_positive(speeds.from, "speeds.from_rad_s");
  require_positive(speeds.to, "speeds.to_rad_s");
  if (speeds.to < speeds.from) {
    throw Error(fmt::format("[squeal] speeds: to_rad_s = {} is below from_rad_s = {}", speeds.to,
                            speeds.from));
  }
  if (speeds.count < 1)
    throw Error(fmt::format("[squeal] speeds.count = {}; it must be 1 or more", speeds.count));
}

void validate_transient(const StudyOptions& study)
{
  if (!study.transient) {
    throw Error(
        "[squeal] analyses: \"transient\", \"limit-cycle\", \"motion-statistics\", "
        "\"spectrum\" and \"spectrogram\" need `transient = { ... }`");
  }
  require_positive(study.transient->speed, "transient.speed_rad_s");
  require_positive(study.transient->duration, "transient.duration_s");
  require_positive(study.transient->initial_pad_displacement, "transient.initial_pad_displacement");
  require_positive(study.transient->growth_error, "transient.growth_error");
  const std::optional<int>& steps = study.transient->steps_per_period;
  if (steps && *steps < steps_per_period_min) {
    throw Error(fmt::format(
        "[squeal] transient.steps_per_period = {}; it must be {} or more to resolve the highest "
        "mode",
        *steps, steps_per_period_min));
  }
}

void validate_growth(const StudyOptions& study)
{
  if (!study.growth || study.growth->speeds.empty())
    throw Error("[squeal] analyses: \"growth\" needs `growth = { speeds_rad_s = [...], ... }`");
  for (const double speed : study.growth->speeds) require_positive(speed, "growth.speeds_rad_s");
  require_positive(study.growth->duration, "growth.duration_s");
}

void validate_direct(const StudyOptions& study)
{
  if (!study.limit_cycle_direct) {
    throw Error(
        "[squeal] analyses: \"limit-cycle-direct\" needs `limit_cycle_direct = { speed_rad_s = ... "
        "}`");
  }
  require_positive(study.limit_cycle_direct->speed, "limit_cycle_direct.speed_rad_s");
}

void validate_map(const StudyOptions& study)
{
  if (!study.map) {
    throw Error(
        "[squeal] analyses: \"stability-map\" needs `map = { parameter = ..., from = ..., to = "
        "..., "
        "count = ... }`");
  }
  require_value_of(study.map->parameter, study.map->from, "map.from");
  if (!(study.map->to >= study.map->from) || !std::isfinite(study.map->to)) {
    throw Error(fmt::format("[squeal] map.to = {}; it must be at least from = {}", study.map->to,
                            study.map->from));
  }
  if (study.map->count < 1)
    throw Error(fmt::format("[squeal] map.count = {}; it must be 1 or more", study.map->count));
}

void validate_critical(const StudyOptions& study)
{
  if (study.critical.empty()) {
    throw Error(
        "[squeal] analyses: \"critical-values\" needs `critical = [{ parameter = ..., from = ..., "
        "to "
        "= ..., speed_rad_s = ... }]`");
  }
  for (const CriticalCase& search : study.critical) {
    require_positive(search.from, "critical.from");
    require_positive(search.speed, "critical.speed_rad_s");
    if (!(search.to > search.from) || !std::isfinite(search.to)) {
      throw Error(fmt::format("[squeal] critical.to = {}; it must be above from = {}", search.to,
                              search.from));
    }
  }
}

void validate_stability(const StudyOptions& study)
{
  const bool own = study.stability.has_value();
  const std::string key = own ? "stability" : "speeds";
  const StabilityCase search = stability_case(study);
  if (search.over)
    require_value_of(*search.over, search.from, key + ".from");
  else
    require_positive(search.from, key + ".from");
  if (search.over) require_positive(search.speed, "stability.speed_rad_s");
  if (!(search.to > search.from) || !std::isfinite(search.to)) {
    throw Error(
        fmt::format("[squeal] {}: to = {} must be above from = {}; \"stability\" follows "
                    "modes over a range",
                    key, search.to, search.from));
  }
  if (search.count < 2) {
    throw Error(fmt::format("[squeal] {}.count = {}; it must be 2 or more for \"stability\"", key,
                            search.count));
  }
  if (!search.band) return;
  require_not_negative(search.band->from_Hz, "stability.band_Hz");
  if (!(search.band->to_Hz > search.band->from_Hz) || !std::isfinite(search.band->to_Hz)) {
    throw Error(
        fmt::format("[squeal] stability.band_Hz = [{}, {}]; its end must be above its begin",
                    search.band->from_Hz, search.band->to_Hz));
  }
}

void validate_sound(const StudyOptions& study)
{
  if (!study.sound) return;
  const int rate = study.sound->rate_Hz;
  if (rate < 8000 || rate > 192000) {
    throw Error(
        fmt::format("[squeal] wav.rate_Hz = {}; it must be 8000 to 192000, e.g. 48000", rate));
  }
}

void validate_analyses(const StudyOptions& study)
{
  for (const std::string& name : study.analyses) {
    if (find_analysis(name)) continue;
    std::vector<std::string_view> names;
    for (const Analysis& analysis : analyses) names.push_back(analysis.name);
    throw Error(
        fmt::format("[squeal] analyses: \"{}\" is not one of {}", name, fmt::join(names, ", ")));
  }
}

void validate_friction(const FrictionLaw& law, const std::string& key)
{
  require_not_negative(law.kinetic, key);
  require_not_negative(law.kinetic + law.rise, key + ".static");
  require_positive(law.decay_speed, key + ".decay_speed");
  require_not_negative(law.regularisation, key + ".regularisation");
}

void validate_brake(const SquealOptions& options)
{
  require_positive(options.thickness, "thickness");
  if (options.planes && options.planes->heights) {
    require_positive((*options.planes->heights)[1] - (*options.planes->heights)[0],
                     "contact_planes: the second minus the first");
  }
  validate_friction(options.friction, "friction");
  for (std::size_t i = 0; i < options.pads.size(); ++i)
    if (options.pads[i].friction)
      validate_friction(*options.pads[i].friction, fmt::format("pads[{}].friction", i));
  validate_modes(options.modes);
  validate_pads(options);
}

}  // namespace

void validate(const Brake& brake, const StudyOptions& study)
{
  const FlexibleDisc* const body = brake.body();
  if (body) validate_brake(body->options());
  validate_analyses(study);
  for (const Analysis& analysis : analyses)
    if (!body && analysis.needs_body && asks_for(study, analysis.name)) {
      throw Error(
          fmt::format("[squeal] analyses: \"{}\" needs a disc with a modal body; leave it out, or "
                      "take model = \"flexible disc\"",
                      analysis.name));
    }
  // The map is one over the speeds too.
  if (needs(study, "speeds") || needs(study, "map")) validate_speeds(study.speeds);
  if (needs(study, "transient")) validate_transient(study);
  if (needs(study, "critical")) validate_critical(study);
  validate_sound(study);
  if (needs(study, "growth")) validate_growth(study);
  if (needs(study, "limit_cycle_direct")) validate_direct(study);
  if (needs(study, "map")) validate_map(study);
  if (asks_for(study, "gradients") && study.gradients && study.gradients->speed)
    require_positive(*study.gradients->speed, "gradients.speed_rad_s");
  if (asks_for(study, "stability")) {
    validate_stability(study);
    if (body) require_band_of(body->disc(), stability_case(study));
  }
  require_parameters(brake, study);
}

}  // namespace chladni::squeal
