#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "cli/describe.hpp"
#include "cli/quantity_table.hpp"

namespace chladni::cli {
namespace {

constexpr double pi = std::numbers::pi;

void add_critical_speed(TextTable& table, const squeal::SquealResults& results)
{
  if (results.critical_speed) {
    add(table, "critical speed", results.critical_speed->speed, "rad/s");
    add(table, "critical speed / pi", results.critical_speed->speed / pi, "rad/s");
    add(table, "critical frequency", results.critical_speed->frequency_Hz, "Hz");
  } else if (results.searched_critical_speed) {
    table.rows.push_back({"critical speed", "none in the range", ""});
  }
}

void add_critical(TextTable& table, const squeal::CriticalValue& value)
{
  const std::string name =
      fmt::format("critical {} at {:.4f} pi rad/s", value.parameter, value.speed / pi);
  if (!value.value) {
    table.rows.push_back({name, "none", ""});
    return;
  }
  add(table, name, *value.value,
      value.parameter == "preload"     ? "N"
      : value.parameter == "stiffness" ? "N/m"
                                       : "");
  add(table, "its frequency", value.frequency_Hz, "Hz");
}

/// The four largest.
void add_peaks(TextTable& table, const squeal::Spectrum& spectrum)
{
  for (std::size_t i = 0; i < std::min<std::size_t>(4, spectrum.peaks.size()); ++i) {
    add(table, fmt::format("pad velocity at {:.2f} Hz", spectrum.peaks[i].frequency_Hz),
        spectrum.peaks[i].amplitude, "m/s");
  }
}

void add_map(TextTable& table, const squeal::StabilityMap& map)
{
  add_count(table, fmt::format("points of the map of speed and {}", map.parameter),
            map.growth.size());
  add_count(table, "unstable ones of them", (map.growth.array() > 0.0).count());
  add(table, "largest growth rate in the map", map.growth.maxCoeff(), "1/s");
}

void add_sensitivity(TextTable& table, const squeal::ModeSensitivity& sensitivity)
{
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
  for (const squeal::ModeSubset& subset : sensitivity.subsets) {
    const std::string name = fmt::format("critical speed / pi, {} modes to {:.0f} Hz",
                                         subset.n_modes, subset.highest_Hz);
    if (!subset.critical_speed) {
      table.rows.push_back({name, "none in the range", ""});
      continue;
    }
    lowest = std::min(lowest, *subset.critical_speed);
    highest = std::max(highest, *subset.critical_speed);
    add(table, name, *subset.critical_speed / pi, "rad/s");
  }
  if (highest > 0.0) add(table, "spread of them", 100.0 * (highest - lowest) / highest, "%");
  for (const squeal::ModeInfluence& mode : sensitivity.influences) {
    const std::string name =
        fmt::format("{:.1f} Hz, {} nodal diameters", mode.frequency_Hz, mode.nodal_diameters);
    if (!mode.growth_without) {
      add(table, "critical mode: " + name, 100.0 * mode.participation, "% of its energy");
    } else if (mode.critical_speed_without) {
      add(table, "critical speed / pi without " + name, *mode.critical_speed_without / pi, "rad/s");
    } else {
      add(table, "growth without " + name, *mode.growth_without, "1/s");
    }
  }
}

void add_limit_cycle(TextTable& table, const squeal::LimitCycle& cycle)
{
  add(table, "limit cycle: speed", cycle.speed, "rad/s");
  add(table, "limit cycle: frequency", cycle.frequency_Hz, "Hz");
  add(table, "limit cycle: pad velocity", cycle.pad_velocity, "m/s");
  add(table, "limit cycle: pad displacement", 1e3 * cycle.pad_displacement, "mm");
  add(table, "limit cycle: least normal force", cycle.N_min, "N");
  add(table, "limit cycle: largest normal force", cycle.N_max, "N");
  if (!cycle.settled) {
    add(table, "limit cycle: not settled, drift", 100.0 * cycle.drift, "%");
  }
}

void add_direct_limit_cycle(TextTable& table, const squeal::DirectLimitCycle& cycle)
{
  add(table, "direct limit cycle: speed", cycle.speed, "rad/s");
  add(table, "direct limit cycle: frequency", cycle.frequency_Hz, "Hz");
  add(table, "direct limit cycle: pad velocity", cycle.pad_velocity, "m/s");
  add(table, "direct limit cycle: pad displacement", 1e3 * cycle.pad_displacement, "mm");
  add(table, "direct limit cycle: least normal force", cycle.N_min, "N");
  add(table, "direct limit cycle: largest normal force", cycle.N_max, "N");
  add(table, "direct limit cycle: largest multiplier", std::abs(cycle.multipliers[1]), "");
  if (!cycle.stable) table.rows.push_back({"direct limit cycle", "not stable", ""});
  add_count(table, "direct limit cycle: contact evaluations", cycle.n_contact_evaluations);
}

void add_branch(TextTable& table, const squeal::LimitCycleBranch& branch)
{
  add_count(table, "limit cycles over speed", static_cast<Eigen::Index>(branch.points.size()));
  if (branch.points.empty()) return;
  for (const squeal::BranchPoint& end : {branch.points.front(), branch.points.back()}) {
    add(table, fmt::format("pad velocity at {:.4f} pi rad/s", end.speed / pi), end.pad_velocity,
        "m/s");
  }
  if (branch.lost_below) add(table, "limit cycle lost below", *branch.lost_below, "rad/s");
}

}  // namespace

TextTable describe(const squeal::SquealResults& results)
{
  TextTable table = quantities();
  if (results.eigenvalues) {
    add_count(table, "speeds with eigenvalues", results.eigenvalues->speeds.size());
  }
  add_critical_speed(table, results);
  for (const squeal::CriticalValue& value : results.critical_values) add_critical(table, value);
  if (results.map) add_map(table, *results.map);
  if (results.mode_sensitivity) add_sensitivity(table, *results.mode_sensitivity);
  for (const squeal::Growth& growth : results.growth) {
    add(table, fmt::format("growth at {:.4f} pi rad/s", growth.speed / pi), growth.rate, "1/s");
  }
  if (results.transient) {
    table.rows.push_back({"integrator of the transient", results.transient->integrator, ""});
  }
  if (results.transient && results.transient->growth_rate) {
    add(table, "growth in the transient", *results.transient->growth_rate, "1/s");
  }
  if (results.transient && !results.transient->finished) {
    table.rows.push_back({"transient", "diverged", ""});
  }
  if (results.limit_cycle) add_limit_cycle(table, *results.limit_cycle);
  if (results.limit_cycle_direct) add_direct_limit_cycle(table, *results.limit_cycle_direct);
  if (results.limit_cycle_branch) add_branch(table, *results.limit_cycle_branch);
  if (results.spectrum) add_peaks(table, *results.spectrum);
  return table;
}

}  // namespace chladni::cli
