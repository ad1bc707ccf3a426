#pragma once

#include <string>
#include <vector>

#include "report/json.hpp"
#include "report/text_table.hpp"
#include "squeal/results/limit_cycle_results.hpp"
#include "squeal/results/sensitivity_results.hpp"
#include "squeal/results/squeal_results.hpp"
#include "squeal/results/stability_results.hpp"
#include "squeal/results/sweep_table.hpp"
#include "squeal/results/transient_results.hpp"

namespace chladni::report {

/// rad/s in revolutions per minute.
double rpm(double rad_s);

/// A speed as text in both units: "18.8496 rad/s (180 rpm)".
std::string spoken(double rad_s);

/// What to doubt of a limit cycle that may not last: "not stable", or that its multipliers do not
/// tell; empty for a stable one.
std::string doubt_of_stability(squeal::CycleStability stability);

/// Adds the rows of a limit cycle at the end of a transient, of the statistics of a motion, of a
/// limit cycle found directly, or of a branch of limit cycles.
void add_limit_cycle(TextTable& table, const squeal::LimitCycle& cycle);
void add_statistics(TextTable& table, const squeal::MotionStatistics& statistics);
void add_direct_limit_cycle(TextTable& table, const squeal::DirectLimitCycle& cycle);
void add_branch(TextTable& table, const squeal::LimitCycleBranch& branch);

/// The change of each result when a number changes by one per cent, the largest effects first.
TextTable gradients_table(const squeal::Gradients& gradients);

/// Adds the rows with the largest effects, at most 20, to a table of quantities.
void add_gradients(TextTable& table, const squeal::Gradients& gradients);

/// The gradients as JSON.
Json gradients_json(const squeal::Gradients& gradients);

/// A table of varied keys and results with the minimum and maximum of each, followed by the failed
/// variants.
TextTable describe(const squeal::SweepTable& sweep);

/// JSON members `variants`, `done`, `failed`, and `failures` with their reasons.
std::vector<Json::Member> sweep_json(const squeal::SweepTable& sweep);

/// Adds the number of unstable modes, then a row for each by ascending frequency: its unstable
/// interval, growth rate with its error and damping ratio at the largest growth, and the modes that
/// take part there.
void add_unstable_modes(TextTable& table, const squeal::StabilityTable& stability);

/// The known parts of an error in words, such as "mesh 0.1, reduction 2e-09".
std::string parts_of(const squeal::ErrorBudget& budget);

/// JSON of the parts of an error; null where they are unknown.
Json budget_json(const squeal::ErrorBudget& budget);

/// JSON of all branches over all values of the parameter, with their unstable intervals and
/// participating modes.
Json stability_table_json(const squeal::StabilityTable& stability);

/// Adds the method of the growth rates, the largest exponents at the least stable speed, and the
/// growth rate of a disc frozen at its worst angle. Adds nothing for files of earlier versions.
void add_rotation_method(TextTable& table, const squeal::RotationStability& stability);

/// JSON members of the results for `squeal run --json`. Only analyses that were asked for are
/// present; `critical_speed_rad_s` is null when there is none in the range.
std::vector<Json::Member> results_json(const squeal::SquealResults& results);

}  // namespace chladni::report
