#pragma once

#include <vector>

#include "report/json.hpp"
#include "report/output.hpp"
#include "report/timing.hpp"

/// Cost of a program for its summaries.
namespace chladni::report {

/// Time and memory of a whole program run.
struct Cost {
  std::vector<PhaseTime> phases;
  double wall_s;    ///< wall time of the slowest rank since the process started, s
  double cpu_s;     ///< CPU time of all ranks since the process started, s
  double peak_MiB;  ///< peak memory of the rank that needed most
};

/// The given phases with the times and the peak memory of this process up to now.
Cost cost_so_far(std::vector<PhaseTime> phases);

/// The cost as a table for the terminal.
TextTable cost_table(const Cost& cost);

/// Members `phases` (name -> wall_s), `phases_cpu_s`, `wall_s`, `cpu_s`, `peak_MiB`.
std::vector<Json::Member> cost_json(const Cost& cost);

}  // namespace chladni::report
