#include "report/describe_cycles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <span>

#include "report/describe_stability.hpp"
#include "report/quantities.hpp"

namespace chladni::report {
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
                        "the disc is not axisymmetric: it ends in no closed orbit, and "
                        "\"motion-statistics\" tells how it squeals",
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

}  // namespace chladni::report
