#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "references/squeal/analytic_body.hpp"
#include "squeal/brake/disc.hpp"

namespace chladni::squeal::bench {

/// Processor time of all threads: what else runs on the machine does not count.
template <class Work>
double seconds_of(const Work& work)
{
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

/// A target and what was measured; a limit of 0 means that there is none.
struct Target {
  std::string name, unit;
  double measured, limit;
};
std::vector<Target> measured_targets(bool smallest);

std::string json_of(const std::vector<Target>& targets);

}  // namespace chladni::squeal::bench
