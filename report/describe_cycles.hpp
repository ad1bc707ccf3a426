#pragma once

#include <string>

#include "report/output.hpp"
#include "squeal/results/cycle_results.hpp"
#include "squeal/results/signal_results.hpp"

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

}  // namespace chladni::report
