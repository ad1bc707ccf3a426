#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "squeal/brake/disc.hpp"
#include "tests/references/squeal/analytic_body.hpp"

namespace chladni::squeal::bench {

/// CPU time of `work()` summed over all threads, s; other processes on the machine do not count.
template <class Work>
double seconds_of(const Work& work)
{
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

/// One performance target and its measured value.
struct Target {
  std::string name, unit;
  double measured, limit;  ///< in `unit`; a limit of 0 means that there is no target
};
/// Runs the benchmarks of the squeal solver and returns their measured values.
/// @param smallest  short runs, for tests
std::vector<Target> measured_targets(bool smallest);

/// The targets as a JSON list of {name, unit, measured, target}.
std::string json_of(const std::vector<Target>& targets);

}  // namespace chladni::squeal::bench
