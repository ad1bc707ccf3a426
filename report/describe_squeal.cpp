#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "report/describe.hpp"
#include "report/describe_cycles.hpp"
#include "report/describe_gradients.hpp"
#include "report/describe_rotation.hpp"
#include "report/describe_stability.hpp"
#include "report/quantities.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/results/analysis_file.hpp"
#include "squeal/results/transient_file.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/transient/growth_rate.hpp"

namespace chladni::report {
namespace {

/// Growth that rounding can make of a neutral motion, relative to the largest frequency of a map.
constexpr double rounding = 1e-12;

/// In all units that there are.
void add_speed(TextTable& table, const std::string& name, double rad_s,
               const std::optional<double>& wheel_radius)
{
  add(table, name, rad_s, "rad/s");
  add(table, name, rpm(rad_s), "rpm");
  if (wheel_radius) add(table, name, 3.6 * rad_s * *wheel_radius, "km/h");
}

/// What the parameter of a search is called and measured in.
struct Searched {
  std::string name;    ///< "speed"
  std::string values;  ///< "speeds"
  std::string unit;    ///< empty for a pure number

  std::string operator()(double value) const
  {
    return unit.empty() ? fmt::format("{:.6g}", value) : fmt::format("{:.6g} {}", value, unit);
  }
};

/// How far the critical speed may be off, and why.
void add_budget(TextTable& table, const squeal::ErrorBudget& budget)
{
  if (budget.is_empty()) return;
  table.rows.push_back({fmt::format("its error ({})", parts_of(budget)),
                        fmt::format("+- {:.2g}", budget.sum()), "rad/s"});
  // Without a tolerance of [body] keep nothing is known of them, and they may count most.
  if (!budget.body)
    table.rows.push_back({"not in this error: modes that the body lacks", "unknown", ""});
}

/// Why there is no value at which stability is lost.
std::string none_because(squeal::Stability stability, const std::string& values)
{
  switch (stability) {
    case squeal::Stability::stable:
      return "none: stable at all " + values;
    case squeal::Stability::unstable:
      return "none: unstable at all " + values;
    default:
      return "none: unstable at first";
  }
}

/// Growth and frequency at both ends of a range without any stability.
void add_ends(TextTable& table, const squeal::StabilityProfile& profile, const Searched& searched)
{
  for (const squeal::StabilityPoint& end : {profile.from, profile.to}) {
    add(table, "growth at " + searched(end.value), end.growth, "1/s");
    add(table, "frequency at " + searched(end.value), end.frequency_Hz, "Hz");
  }
}

/// All intervals, unless there is one alone that begins at the critical value and has no end.
void add_intervals(TextTable& table, const squeal::StabilityProfile& profile,
                   const Searched& searched)
{
  if (profile.unstable.empty()) return;
  if (squeal::stability_of(profile) == squeal::Stability::unstable) {
    add_ends(table, profile, searched);
    return;
  }
  const bool alone = profile.unstable.size() == 1;
  if (alone && !squeal::first_regain(profile)) return;
  for (const squeal::UnstableInterval& interval : profile.unstable) {
    const std::string name = fmt::format("unstable from {} to {}", searched(interval.from.value),
                                         searched(interval.to.value));
    add(table, name + ", growth up to", interval.worst.growth, "1/s");
    add(table, "its frequency there", interval.worst.frequency_Hz, "Hz");
  }
}

void add_critical_speed(TextTable& table, const squeal::SquealResults& results)
{
  const Searched speed{"speed", "speeds", "rad/s"};
  if (results.critical_speed) {
    add_speed(table, "critical speed", results.critical_speed->speed, results.wheel_radius);
    add(table, "critical frequency", results.critical_speed->frequency_Hz, "Hz");
    add_budget(table, results.critical_speed->budget);
  } else if (results.speed_stability) {
    const squeal::Stability stability = squeal::stability_of(*results.speed_stability);
    table.rows.push_back({"critical speed", none_because(stability, speed.values), ""});
  } else if (results.searched_critical_speed) {
    // A file of an earlier version does not tell stable from unstable.
    table.rows.push_back({"critical speed", "stability is not lost in the range", ""});
  }
  if (!results.speed_stability) return;
  add_intervals(table, *results.speed_stability, speed);
  if (results.speed_stability->method == "hill")
    table.rows.push_back({"method of the critical speed", "Hill", ""});
}

void add_critical(TextTable& table, const squeal::CriticalValue& value)
{
  const std::string unit = squeal::unit_of(value.parameter);
  const Searched searched{value.parameter, "values", unit == "1" ? "" : unit};
  const bool regained =
      value.profile && squeal::stability_of(*value.profile) == squeal::Stability::regained;
  const std::string name = fmt::format("critical {} at {}{}", value.parameter, spoken(value.speed),
                                       regained ? ", stable above" : "");
  if (value.value) {
    add(table, name, *value.value, searched.unit);
    add(table, "its frequency", value.frequency_Hz, "Hz");
  } else {
    const std::string why =
        value.profile ? none_because(squeal::stability_of(*value.profile), searched.values)
                      : "stability does not change in the range";
    table.rows.push_back({name, why, ""});
  }
  if (value.profile) add_intervals(table, *value.profile, searched);
}

/// The four largest. Those of a transient that has not settled are no lines of a limit cycle.
void add_peaks(TextTable& table, const squeal::SquealResults& results)
{
  const squeal::Spectrum& spectrum = *results.spectrum;
  const std::string_view whose =
      squeal::has_unsettled_end(results) ? "end of the transient, not settled: " : "";
  for (std::size_t i = 0; i < std::min<std::size_t>(4, spectrum.peaks.size()); ++i) {
    add(table, fmt::format("{}pad velocity at {:.2f} Hz", whose, spectrum.peaks[i].frequency_Hz),
        spectrum.peaks[i].amplitude, "m/s");
  }
}

void add_map(TextTable& table, const squeal::StabilityMap& map)
{
  add_count(table, fmt::format("points of the map of speed and {}", map.parameter),
            map.growth.size());
  const double zero = rounding * 2.0 * std::numbers::pi * map.frequency_Hz.maxCoeff();
  add_count(table, "unstable ones of them", (map.growth.array() > zero).count());
  add(table, "largest growth rate in the map", map.growth.maxCoeff(), "1/s");
}

void add_rotation_stability(TextTable& table, const squeal::RotationStability& stability,
                            const std::optional<double>& wheel_radius)
{
  add(table, "largest growth rate over the speeds (rotation)", stability.growth.maxCoeff(), "1/s");
  if (stability.critical_speed) {
    add_speed(table, "critical speed (rotation)", *stability.critical_speed, wheel_radius);
  } else {
    const std::string why = none_because(squeal::stability_of(stability), "speeds");
    table.rows.push_back({"critical speed (rotation)", why, ""});
    if (stability.growth.minCoeff() > 0.0) {
      add(table, "least growth rate over the speeds (rotation)", stability.growth.minCoeff(),
          "1/s");
    }
  }
  add_rotation_method(table, stability);
}

void add_sensitivity(TextTable& table, const squeal::ModeSensitivity& sensitivity)
{
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
  for (const squeal::ModeSubset& subset : sensitivity.subsets) {
    const std::string name =
        fmt::format("critical speed, {} modes to {:.0f} Hz", subset.n_modes, subset.highest_Hz);
    if (!subset.critical_speed) {
      // A file of an earlier version does not tell stable from unstable.
      table.rows.push_back(
          {name, "none: " + (subset.stability.empty() ? "not lost in the range" : subset.stability),
           ""});
      continue;
    }
    lowest = std::min(lowest, *subset.critical_speed);
    highest = std::max(highest, *subset.critical_speed);
    add(table, name, *subset.critical_speed, "rad/s");
  }
  if (highest > 0.0) add(table, "spread of them", 100.0 * (highest - lowest) / highest, "%");
  for (const squeal::ModeInfluence& mode : sensitivity.influences) {
    const std::string name =
        fmt::format("{:.1f} Hz, {} nodal diameters", mode.frequency_Hz, mode.nodal_diameters);
    if (!mode.growth_without)
      add(table, "critical mode: " + name, 100.0 * mode.participation, "% of its energy");
    else if (mode.critical_speed_without)
      add(table, "critical speed without " + name, *mode.critical_speed_without, "rad/s");
    else
      add(table, "growth without " + name, *mode.growth_without, "1/s");
  }
}

/// What a run measured stands beside it where that is another motion's.
void add_growth(TextTable& table, const squeal::Growth& growth)
{
  const std::string name = "growth at " + spoken(growth.speed);
  add(table, name, squeal::told_rate(growth), "1/s");
  if (growth.eigenvalue_rate && squeal::disagree(growth.rate, *growth.eigenvalue_rate))
    add(table, name + ", measured in a run too short for it", growth.rate, "1/s");
}

/// Why results that were asked for are not there.
void add_missing(TextTable& table, const squeal::SquealResults& results)
{
  if (results.failure) table.rows.push_back({"failed", *results.failure, ""});
  if (results.missing.empty()) return;
  const std::string why = results.failure ? "an analysis failed"
                                          : "the run was interrupted, or still lasts; `squeal run "
                                            "--resume` goes on";
  table.rows.push_back(
      {"incomplete", fmt::format("missing: {}; {}", fmt::join(results.missing, ", "), why), ""});
}

void add_transient(TextTable& table, const squeal::Transient& run)
{
  table.rows.push_back({"integrator of the transient", run.integrator, ""});
  table.rows.push_back({"history of the transient", squeal::spoken(run.band), ""});
  if (run.growth_rate) add(table, "growth in the transient", *run.growth_rate, "1/s");
  if (!run.warning.empty()) table.rows.push_back({"transient, doubtful", run.warning, ""});
  if (!run.finished) table.rows.push_back({"transient", "diverged", ""});
}

}  // namespace

TextTable describe(const squeal::SquealResults& results)
{
  TextTable table = quantities();
  add_missing(table, results);
  if (results.eigenvalues)
    add_count(table, "speeds with eigenvalues", results.eigenvalues->speeds.size());
  add_critical_speed(table, results);
  for (const squeal::CriticalValue& value : results.critical_values) add_critical(table, value);
  if (results.stability_table) add_unstable_modes(table, *results.stability_table);
  if (results.map) add_map(table, *results.map);
  if (results.rotation_stability)
    add_rotation_stability(table, *results.rotation_stability, results.wheel_radius);
  if (results.mode_sensitivity) add_sensitivity(table, *results.mode_sensitivity);
  if (results.gradients) add_gradients(table, *results.gradients);
  for (const squeal::Growth& growth : results.growth) add_growth(table, growth);
  if (results.transient) add_transient(table, *results.transient);
  if (results.motion_statistics) add_statistics(table, *results.motion_statistics);
  if (results.limit_cycle) add_limit_cycle(table, *results.limit_cycle);
  if (results.limit_cycle_direct) add_direct_limit_cycle(table, *results.limit_cycle_direct);
  if (results.limit_cycle_branch) add_branch(table, *results.limit_cycle_branch);
  if (results.spectrum) add_peaks(table, results);
  return table;
}

}  // namespace chladni::report
