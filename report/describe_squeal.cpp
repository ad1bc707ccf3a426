#include "report/describe_squeal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/describe_body.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"
#include "squeal/cycle/limit_cycle.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/transient_results.hpp"
#include "squeal/stability/rotation_stability.hpp"
#include "squeal/stability/stability_search.hpp"
#include "squeal/transient/transient.hpp"

namespace chladni::report {

using squeal::VariantState;

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

/// Of one matrix of a disc that is not axisymmetric: those that grow where one grows most, the
/// worst first; that one at least.
void add_named_eigenvalues(TextTable& table, const squeal::EigenvalueMap& map)
{
  constexpr std::size_t most_told = 8;
  Eigen::Index at = 0;
  map.lambda.real().rowwise().maxCoeff().maxCoeff(&at);
  std::vector<std::complex<double>> lambda(map.lambda.row(at).begin(), map.lambda.row(at).end());
  std::ranges::sort(lambda, std::ranges::greater(), [](const auto& one) { return one.real(); });
  std::string of = map.of;
  if (map.angles.size() > 0)
    of += fmt::format(", {:.4g} degrees", map.angles[at] * 180.0 / std::numbers::pi);
  for (std::size_t j = 0; j < std::min(most_told, lambda.size()); ++j) {
    if (j > 0 && !(lambda[j].real() > rounding * std::abs(lambda[j]))) return;
    add(table,
        fmt::format("growth at {:.6g} rad/s of {:.2f} Hz ({})", map.speeds[at],
                    lambda[j].imag() / (2.0 * std::numbers::pi), of),
        lambda[j].real(), "1/s");
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
  const double zero = std::max(rounding * 2.0 * std::numbers::pi * map.frequency_Hz.maxCoeff(),
                               map.error.value_or(0.0));
  add_count(table, "unstable ones of them", (map.growth.array() > zero).count());
  add(table, "largest growth rate in the map", map.growth.maxCoeff(), "1/s");
  if (map.method.empty()) return;
  table.rows.push_back({"method of the map", "Hill", ""});
  add(table, "estimated error of the map's growth rates", map.error.value_or(0.0), "1/s");
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
  for (const auto& map : {results.eigenvalues, results.frozen_eigenvalues})
    if (map && !map->of.empty()) add_named_eigenvalues(table, *map);
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

namespace {

/// Of the strongest lines of a spectrum, in a table.
constexpr int n_lines_told = 5;

/// A number of a limit cycle, and its error with its parts.
struct ToldNumber {
  const char* name;
  const char* unit;
  double value;
  squeal::ErrorBudget budget;
};

void add_with_error(TextTable& table, const ToldNumber& told)
{
  const std::string name = fmt::format("direct limit cycle: {}", told.name);
  add(table, name, told.value, told.unit);
  if (told.budget.is_empty()) return;
  table.rows.push_back({fmt::format("its error ({})", parts_of(told.budget)),
                        fmt::format("+- {:.2g}", told.budget.sum()), told.unit});
}

squeal::ErrorBudget in_mm(squeal::ErrorBudget budget)
{
  for (auto* part :
       {&budget.mesh, &budget.reduction, &budget.body, &budget.left_out, &budget.integration})
    if (*part) **part *= 1e3;
  return budget;
}

}  // namespace

double rpm(double rad_s)
{
  return rad_s * 30.0 / std::numbers::pi;
}

std::string spoken(double rad_s)
{
  return fmt::format("{:.6g} rad/s ({:.4g} rpm)", rad_s, rpm(rad_s));
}

std::string doubt_of_stability(squeal::CycleStability stability)
{
  switch (stability) {
    case squeal::CycleStability::stable:
      return "";
    case squeal::CycleStability::unstable:
      return "not stable";
    default:
      return "stable or not: undecided within its error";
  }
}

void add_limit_cycle(TextTable& table, const squeal::LimitCycle& cycle)
{
  // What still grows or decays is the end of a transient and no limit cycle.
  const std::string name = cycle.settled ? "limit cycle: " : "end of the transient, not settled: ";
  add(table, name + "speed", cycle.speed, "rad/s");
  add(table, name + "frequency", cycle.frequency_Hz, "Hz");
  add(table, name + "pad velocity", cycle.pad_velocity, "m/s");
  add(table, name + "pad displacement", 1e3 * cycle.pad_displacement, "mm");
  add(table, name + "least normal force", cycle.N_min, "N");
  add(table, name + "largest normal force", cycle.N_max, "N");
  if (!cycle.settled) add(table, name + "drift", 100.0 * cycle.drift, "%");
  if (cycle.amplitude.size() > 0 || cycle.mode_numbers.empty()) return;
  table.rows.push_back({"end of the transient",
                        "the disc is not axisymmetric: its motion ends in no closed orbit; "
                        "\"motion-statistics\" shows how it squeals",
                        ""});
}

void add_statistics(TextTable& table, const squeal::MotionStatistics& statistics)
{
  const std::string name = fmt::format("last {} rotations{}: ", statistics.n_rotations,
                                       statistics.settled ? "" : ", not settled");
  add(table, name + "speed", statistics.speed, "rad/s");
  add(table, name + "effective pad velocity", statistics.rms_velocity, "m/s");
  add(table, name + "largest pad velocity", statistics.peak_velocity, "m/s");
  add(table, name + "largest pad displacement", 1e3 * statistics.peak_displacement, "mm");
  add(table, name + "least normal force", statistics.N_min, "N");
  add(table, name + "largest normal force", statistics.N_max, "N");
  add(table, name + "modulation by the rotation", 100.0 * statistics.modulation, "%");
  if (!statistics.settled) add(table, name + "drift", 100.0 * statistics.drift, "%");
  const auto n_told = std::min<std::size_t>(statistics.lines.size(), n_lines_told);
  for (const auto& line : std::span(statistics.lines).first(n_told))
    add(table, fmt::format("{}line at {:.6g} Hz", name, line.frequency_Hz), line.amplitude, "m/s");
}

void add_direct_limit_cycle(TextTable& table, const squeal::DirectLimitCycle& cycle)
{
  add(table, "direct limit cycle: speed", cycle.speed, "rad/s");
  add_with_error(table, {"frequency", "Hz", cycle.frequency_Hz, cycle.errors.frequency_Hz});
  add_with_error(table, {"pad velocity", "m/s", cycle.pad_velocity, cycle.errors.pad_velocity});
  add_with_error(table, {"pad displacement", "mm", 1e3 * cycle.pad_displacement,
                         in_mm(cycle.errors.pad_displacement)});
  add(table, "direct limit cycle: least normal force", cycle.N_min, "N");
  add(table, "direct limit cycle: largest normal force", cycle.N_max, "N");
  add(table, "direct limit cycle: largest multiplier", std::abs(cycle.multipliers[1]), "");
  if (cycle.multiplier_error) {
    table.rows.push_back(
        {"its error (integration)", fmt::format("+- {:.1g}", *cycle.multiplier_error), ""});
  }
  const std::string doubt = doubt_of_stability(squeal::stability_of(cycle));
  if (!doubt.empty()) table.rows.push_back({"direct limit cycle", doubt, ""});
  add_count(table, "direct limit cycle: contact evaluations", cycle.n_contact_evaluations);
  if (!cycle.way.empty()) table.rows.push_back({"direct limit cycle: found", cycle.way, ""});
}

void add_branch(TextTable& table, const squeal::LimitCycleBranch& branch)
{
  add_count(table, "limit cycles over speed", static_cast<Eigen::Index>(branch.points.size()));
  if (branch.origin) {
    add(table, "limit cycles begin at the Hopf point", branch.origin->speed, "rad/s");
    const bool forward = branch.origin->first.speed > branch.origin->speed;
    table.rows.push_back(
        {"limit cycles begin towards", forward ? "higher speeds" : "lower speeds", ""});
  }
  if (!branch.note.empty()) table.rows.push_back({"limit cycles over speed", branch.note, ""});
  if (branch.points.empty()) return;
  for (const squeal::BranchPoint& end : {branch.points.front(), branch.points.back()})
    add(table, "pad velocity at " + spoken(end.speed), end.pad_velocity, "m/s");
  for (const squeal::BranchPoint& fold : branch.folds)
    add(table, "fold of the limit cycle at", fold.speed, "rad/s");
  if (branch.lost_below) add(table, "limit cycle lost below", *branch.lost_below, "rad/s");
  if (branch.lost_above) add(table, "limit cycle lost above", *branch.lost_above, "rad/s");
}

namespace {

constexpr std::size_t rows_told = 20;

/// "+0.012" of the usual change
std::string effect(const squeal::GradientRow& row, double derivative)
{
  const double change = squeal::usual_change(row).value * derivative;
  return change == 0.0 ? "0" : fmt::format("{:+.3g}", change);
}

}  // namespace

TextTable gradients_table(const squeal::Gradients& gradients)
{
  TextTable table{.header = {"number raised by 1 %", "value", "unit"}, .rows = {}};
  if (gradients.critical_speed) table.header.emplace_back("critical speed, rad/s");
  for (const squeal::GradientMotion& motion : gradients.motions)
    table.header.push_back(fmt::format("growth at {:.5g} Hz, 1/s", motion.frequency_Hz));
  for (const squeal::GradientRow& row : gradients.rows) {
    const std::string change = squeal::usual_change(row).name;
    std::vector<std::string> cells{
        change == "1 %" ? row.key : fmt::format("{} (by +{})", row.key, change),
        fmt::format("{:.6g}", row.value), row.unit};
    if (gradients.critical_speed) cells.push_back(effect(row, row.critical_speed.value_or(0.0)));
    for (const double growth : row.growth) cells.push_back(effect(row, growth));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

void add_gradients(TextTable& table, const squeal::Gradients& gradients)
{
  const bool of_speed = gradients.critical_speed.has_value();
  if (of_speed) add(table, "critical speed (gradients)", *gradients.critical_speed, "rad/s");
  if (gradients.speed && !gradients.motions.empty()) {
    add(table, fmt::format("largest growth at {:.6g} rad/s (gradients)", *gradients.speed),
        gradients.motions.front().growth, "1/s");
  }
  for (std::size_t i = 0; i < std::min(rows_told, gradients.rows.size()); ++i) {
    const squeal::GradientRow& row = gradients.rows[i];
    const double derivative = of_speed                ? row.critical_speed.value_or(0.0)
                              : row.growth.size() > 0 ? row.growth[0]
                                                      : 0.0;
    add(table,
        fmt::format("+{} of {} moves the {} by", squeal::usual_change(row).name, row.key,
                    of_speed ? "critical speed" : "largest growth"),
        squeal::usual_change(row).value * derivative, of_speed ? "rad/s" : "1/s");
  }
}

Json gradients_json(const squeal::Gradients& gradients)
{
  std::vector<Json> motions, rows;
  for (const squeal::GradientMotion& motion : gradients.motions) {
    motions.push_back(
        Json::object({{"growth_1_s", motion.growth}, {"frequency_Hz", motion.frequency_Hz}}));
  }
  for (const squeal::GradientRow& row : gradients.rows) {
    std::vector<Json> growth(row.growth.begin(), row.growth.end());
    rows.push_back(Json::object({{"key", row.key},
                                 {"unit", row.unit},
                                 {"value", row.value},
                                 {"critical_speed_by_value", optional_json(row.critical_speed)},
                                 {"growth_by_value", Json::array(growth)}}));
  }
  return Json::object({{"critical_speed_rad_s", optional_json(gradients.critical_speed)},
                       {"critical_frequency_Hz", optional_json(gradients.critical_frequency_Hz)},
                       {"speed_rad_s", optional_json(gradients.speed)},
                       {"motions", Json::array(motions)},
                       {"rows", Json::array(rows)}});
}

namespace {

/// The least and the largest of the numbers of a column that are known.
struct SweptRange {
  std::size_t n = 0;
  double least = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();

  void add(double x)
  {
    ++n;
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
};

std::vector<std::string> row_of(const std::string& name, const SweptRange& range)
{
  if (range.n == 0) return {name, "", "", "0"};
  return {name, fmt::format("{:.6g}", range.least), fmt::format("{:.6g}", range.largest),
          fmt::format("{}", range.n)};
}

SweptRange range_of(const squeal::SweepTable& sweep, Eigen::Index column)
{
  SweptRange range;
  for (Eigen::Index i = 0; i < sweep.results.rows(); ++i)
    if (sweep.known(i, column)) range.add(sweep.results(i, column));
  return range;
}

void add_failures(TextTable& table, const squeal::SweepTable& sweep)
{
  constexpr std::size_t most = 20;
  std::size_t told = 0;
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    if (sweep.failures[i].empty() || ++told > most) continue;
    table.rows.push_back({fmt::format("variant {}: {}: {}", i + 1, name_of_variant(sweep, i),
                                      printable(sweep.failures[i])),
                          "", "", ""});
  }
  if (told > most)
    table.rows.push_back({fmt::format("and {} more that failed", told - most), "", "", ""});
}

}  // namespace

TextTable describe(const squeal::SweepTable& sweep)
{
  TextTable table{.header = {"", "least", "largest", "variants"}, .rows = {}};
  for (std::size_t k = 0; k < sweep.keys.size(); ++k) {
    SweptRange range;
    for (const double value : sweep.values.col(static_cast<Eigen::Index>(k))) range.add(value);
    table.rows.push_back(row_of(printable(sweep.keys[k]), range));
  }
  for (std::size_t j = 0; j < sweep.columns.size(); ++j) {
    table.rows.push_back(
        row_of(printable(sweep.columns[j].name), range_of(sweep, static_cast<Eigen::Index>(j))));
  }
  const auto count = [&](const char* name, VariantState state) {
    if (const std::size_t n = sweep.count(state))
      table.rows.push_back({name, "", "", fmt::format("{}", n)});
  };
  count("done", VariantState::done);
  count("failed", VariantState::failed);
  count("still to do: squeal sweep --resume", VariantState::to_do);
  add_failures(table, sweep);
  return table;
}

std::vector<Json::Member> sweep_json(const squeal::SweepTable& sweep)
{
  std::vector<Json> failures;
  for (std::size_t i = 0; i < sweep.n_variants(); ++i) {
    if (sweep.failures[i].empty()) continue;
    failures.push_back(Json::object(
        {{"variant", i + 1}, {"of", name_of_variant(sweep, i)}, {"reason", sweep.failures[i]}}));
  }
  return {{"variants", sweep.n_variants()},
          {"done", sweep.count(VariantState::done)},
          {"failed", sweep.count(VariantState::failed)},
          {"failures", Json::array(failures)}};
}

}  // namespace chladni::report
