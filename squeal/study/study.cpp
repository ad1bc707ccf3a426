#include "squeal/study/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "squeal/cycle/cycle_errors.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/cycle/limit_cycle_branch.hpp"
#include "squeal/cycle/limit_cycle_direct.hpp"
#include "squeal/models/flexible_disc.hpp"
#include "squeal/numerics.hpp"
#include "squeal/stability/eigenvalues.hpp"
#include "squeal/stability/error_budget.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/sensitivity.hpp"
#include "squeal/stability/stability_map.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/stability/unstable_modes.hpp"
#include "squeal/study_options.hpp"
#include "squeal/transient/motion_statistics.hpp"
#include "squeal/transient/spectrum.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::squeal {

namespace {

bool contains(const std::vector<std::string>& names, std::string_view name)
{
  return std::ranges::find(names, name) != names.end();
}

/// Whether the analyses ask for a step, or for one that begins with its result.
bool is_asked_for(const AnalysisStep& step, const std::vector<std::string>& analyses)
{
  return contains(analyses, step.name) ||
         std::ranges::any_of(step.serves, [&](auto name) { return contains(analyses, name); });
}

/// Whether a run that goes on has to do a step. The limit cycle is measured on what a file does not
/// hold of its transient.
bool is_to_do(const AnalysisStep& step, const std::vector<std::string>& missing)
{
  return contains(missing, step.name) ||
         (step.name == "transient" && contains(missing, "limit-cycle"));
}

/// What there is so far. A disk that is full meanwhile ends no study; what is written at its end
/// tells of it.
void keep_unfinished(const StudyKeeping& keeping, const SquealResults& results)
{
  if (!keeping.unfinished) return;
  try {
    keeping.unfinished(results);
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch)
  }
}

/// The steps, and the results with which they begin.
struct Beginning {
  std::vector<AnalysisStep> to_do;
  SquealResults results;
  bool goes_on;  ///< where another run has ended
};

Beginning beginning_of(const Study& study, const StudyKeeping& keeping)
{
  Beginning begin{.to_do = {}, .results = {}, .goes_on = !keeping.begin.missing.empty()};
  SquealResults& results = begin.results;
  results.wheel_radius = study.options.speeds.wheel_radius;
  if (const FlexibleDisc* body = study.brake.body(); body && body->find_inertial())
    results.largest_split = body->inertial().largest_split;
  if (begin.goes_on) results = keeping.begin;
  results.failure.reset();
  results.missing.clear();
  for (const AnalysisStep& step : analysis_steps()) {
    if (!is_asked_for(step, study.options.analyses)) continue;
    if (begin.goes_on && !is_to_do(step, keeping.begin.missing)) continue;
    begin.to_do.push_back(step);
    results.missing.emplace_back(step.name);
  }
  return begin;
}

}  // namespace

SquealResults run(const Brake& brake, const StudyOptions& options, const StudyKeeping& keeping)
{
  validate(brake, options);
  TurningTables turning;
  const Study study{brake, options, turning};
  Beginning begin = beginning_of(study, keeping);
  const std::vector<AnalysisStep>& to_do = begin.to_do;
  SquealResults& results = begin.results;
  bool any_done = begin.goes_on;
  if (keeping.unfinished && !to_do.empty()) keeping.unfinished(results);
  double done = 0.0, all = 0.0;
  for (const AnalysisStep& step : to_do) all += step.share;
  for (const AnalysisStep& step : to_do) {
    if (any_done) keep_unfinished(keeping, results);
    const std::string name(step.name);
    const auto report = [&](double fraction) {
      if (keeping.progress) keeping.progress(name, (done + fraction * step.share) / all);
    };
    report(0.0);
    try {
      step.perform(study, results, {report, keeping.sound});
    } catch (const Error& error) {
      results.failure = error.what();
      keep_unfinished(keeping, results);
      if (!any_done) throw;
      return std::move(begin.results);
    }
    std::erase(results.missing, name);
    any_done = true;
    report(1.0);
    done += step.share;
  }
  if (results.transient && !results.transient->finished)
    results.failure = "transient: " + divergence_of(*results.transient);
  return std::move(begin.results);
}

namespace {

void find_eigenvalues(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const FlexibleDisc* body = study.brake.body();
  if (!study.brake.is_autonomous()) {
    TurningEigenvalues found = turning_eigenvalues(body->disc(), body->options());
    results.eigenvalues = std::move(found.mean);
    results.frozen_eigenvalues = std::move(found.frozen);
    return;
  }
  EigenvalueMap map = eigenvalues(state_matrix_at(study.brake), study.options.speeds);
  if (body) {
    map.shapes = mode_shapes(body->inertial(), body->options(), map);
    map.mode_numbers = body->disc().mode_numbers;
  }
  results.eigenvalues = std::move(map);
}

/// Over the speed, of a disc that is not axisymmetric.
StabilityTable turning_table_over_speed(const Study& study)
{
  const SpeedRange& speeds = study.options.speeds;
  return study.turning.table(
      *study.brake.body(),
      {.over = {}, .from = speeds.from, .to = speeds.to, .count = speeds.count, .band = {}});
}

void find_critical_speed(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const FlexibleDisc* body = study.brake.body();
  if (study.brake.is_autonomous()) {
    results.speed_stability =
        stability_over_speed(state_matrix_at(study.brake), study.options.speeds);
    results.critical_speed = critical_speed(*results.speed_stability);
    if (results.critical_speed && body)
      results.critical_speed->budget = error_budget(*body, *results.critical_speed);
  } else {
    const StabilityTable table = turning_table_over_speed(study);
    results.speed_stability = profile_of(table);
    results.critical_speed = turning_critical_speed(*body, table);
  }
  results.searched_critical_speed = true;
}

void find_unstable_modes(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const auto by_hill = [&](const FlexibleDisc& body, const StabilityCase& search) {
    return study.turning.table(body, search);
  };
  results.stability_table = unstable_modes(study.brake, stability_case(study.options), by_hill);
}

void find_critical_values(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  std::vector<CriticalValue> values;
  for (const CriticalCase& search : study.options.critical) {
    if (study.brake.is_autonomous()) {
      values.push_back(critical_value(study.brake, search));
      continue;
    }
    constexpr int n_values = 33;
    values.push_back(critical_value(
        search, profile_of(study.turning.table(*study.brake.body(), {.over = search.parameter,
                                                                     .from = search.from,
                                                                     .to = search.to,
                                                                     .count = n_values,
                                                                     .speed = search.speed}))));
  }
  results.critical_values = std::move(values);
}

void find_map(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const MapCase& range = study.options.map.value();
  results.map = study.brake.is_autonomous()
                    ? stability_map(study.brake, range, study.options.speeds)
                    : turning_map(*study.brake.body(), range, study.options.speeds);
}

void find_mode_sensitivity(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const FlexibleDisc& body = *study.brake.body();
  results.mode_sensitivity = mode_sensitivity(body.inertial(), body.options());
}

void find_gradients(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  if (study.brake.is_autonomous()) {
    results.gradients = gradients(study.brake, study.options);
    return;
  }
  const FlexibleDisc& body = *study.brake.body();
  results.gradients = turning_gradients(
      body, study.options, turning_critical_speed(body, turning_table_over_speed(study)));
}

void find_rotation_stability(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  const FlexibleDisc& body = *study.brake.body();
  results.rotation_stability = rotation_stability(body.disc(), body.options());
}

void find_growth(const Study& study, SquealResults& results, const Keeping& keeping)
{
  const GrowthCase& runs = study.options.growth.value();
  std::vector<Growth> found(runs.speeds.size());
  std::mutex telling;
  std::size_t n_done = 0;
  for_each_index(static_cast<int>(found.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    found[at] = growth(study.brake, runs.speeds[at], runs.duration);
    const std::lock_guard lock(telling);
    keeping.progress(double(++n_done) / double(found.size()));
  });
  results.growth = std::move(found);
}

void find_transient(const Study& study, SquealResults& results, const Keeping& keeping)
{
  results.transient = transient(study.brake, study.options.transient.value(), keeping);
}

void find_spectrum(const Study& /*study*/, SquealResults& results, const Keeping& /*keeping*/)
{
  results.spectrum = spectrum(results.transient->tail.pad_velocity, results.transient->step);
}

void find_spectrogram(const Study& /*study*/, SquealResults& results, const Keeping& /*keeping*/)
{
  results.spectrogram = spectrogram(*results.transient);
}

void find_motion_statistics(const Study& /*study*/, SquealResults& results,
                            const Keeping& /*keeping*/)
{
  results.motion_statistics = motion_statistics(*results.transient);
}

void find_limit_cycle(const Study& /*study*/, SquealResults& results, const Keeping& /*keeping*/)
{
  results.limit_cycle = limit_cycle(*results.transient);
}

void find_limit_cycle_direct(const Study& study, SquealResults& results, const Keeping& /*keeping*/)
{
  DirectLimitCycle cycle =
      limit_cycle_direct(study.brake, study.options.limit_cycle_direct.value().speed);
  cycle.errors = cycle_errors(study.brake, cycle);
  results.limit_cycle_direct = std::move(cycle);
}

void find_limit_cycle_branch(const Study& study, SquealResults& results, const Keeping& keeping)
{
  results.limit_cycle_branch =
      limit_cycle_branch(study.brake, study.options.speeds, keeping.progress);
}

}  // namespace

std::span<const AnalysisStep> analysis_steps()
{
  static const AnalysisStep steps[] = {
      {"eigenvalues", 1.0, {}, find_eigenvalues},
      {"critical-speed", 1.0, {}, find_critical_speed},
      {"stability", 5.0, {}, find_unstable_modes},
      {"critical-values", 2.0, {}, find_critical_values},
      {"stability-map", 10.0, {}, find_map},
      {"mode-sensitivity", 10.0, {}, find_mode_sensitivity},
      {"gradients", 3.0, {}, find_gradients},
      {"rotation-stability", 20.0, {}, find_rotation_stability},
      {"growth", 40.0, {}, find_growth},
      {"transient",
       60.0,
       {"limit-cycle", "motion-statistics", "spectrum", "spectrogram"},
       find_transient},
      {"spectrum", 1.0, {}, find_spectrum},
      {"spectrogram", 1.0, {}, find_spectrogram},
      {"motion-statistics", 1.0, {}, find_motion_statistics},
      {"limit-cycle", 1.0, {}, find_limit_cycle},
      {"limit-cycle-direct", 10.0, {}, find_limit_cycle_direct},
      {"limit-cycle-branch", 40.0, {}, find_limit_cycle_branch},
  };
  return steps;
}

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
  const double longest = double(wav_samples_max) / rate;
  if (study.transient && study.transient->duration > longest) {
    throw Error(fmt::format(
        "[squeal] wav.rate_Hz = {}: a WAV file holds up to 4 GiB, {:.0f} s at this rate, "
        "and transient.duration_s = {}; take a lower rate, a shorter transient, or no "
        "wav",
        rate, longest, study.transient->duration));
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
