#pragma once

#include <string>

#include "squeal/results/results.hpp"

namespace chladni::report {

/// Where the brake squeals over the speed, for the first line of a page: "squeals from 13.4 to 20.1
/// rad/s at 1000 Hz", "on" instead of the end where stability does not return within the range.
/// @param results  with a critical speed
std::string where_it_squeals(const squeal::SquealResults& results);

/// What a motion is called that the page shows: "Limit cycle at 18.8 rad/s", or what it is where it
/// has not settled or is not stable.
std::string name_of(const squeal::LimitCycle& cycle);
std::string name_of(const squeal::DirectLimitCycle& cycle);

}  // namespace chladni::report
