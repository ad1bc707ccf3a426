#pragma once

#include <string>

#include "report/output.hpp"
#include "squeal/results/cycle_results.hpp"
#include "squeal/results/signal_results.hpp"

namespace chladni::report {

/// Revolutions per minute.
double rpm(double rad_s);

/// "18.8496 rad/s (180 rpm)"
std::string spoken(double rad_s);

/// The rows of the limit cycle at the end of a transient, of one that was found directly, and of a
/// branch of limit cycles.
void add_limit_cycle(TextTable& table, const squeal::LimitCycle& cycle);
void add_statistics(TextTable& table, const squeal::MotionStatistics& statistics);
void add_direct_limit_cycle(TextTable& table, const squeal::DirectLimitCycle& cycle);
void add_branch(TextTable& table, const squeal::LimitCycleBranch& branch);

}  // namespace chladni::report
