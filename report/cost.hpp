#pragma once

#include <vector>

#include "report/json.hpp"
#include "report/output.hpp"
#include "report/timing.hpp"

/// What a program cost, for its summaries.
namespace chladni::report {

/// Time and memory of a whole program.
struct Cost {
  std::vector<PhaseTime> phases;
  double wall_s;    ///< of the slowest rank, from the start of the process
  double cpu_s;     ///< of all ranks, from the start of the process
  double peak_MiB;  ///< of the rank that needed most
};

/// The phases so far with the times and the peak memory of this process.
Cost cost_so_far(std::vector<PhaseTime> phases);

TextTable cost_table(const Cost& cost);

/// Members `phases` (name -> wall_s), `phases_cpu_s`, `wall_s`, `cpu_s`, `peak_MiB`.
std::vector<Json::Member> cost_json(const Cost& cost);

}  // namespace chladni::report
