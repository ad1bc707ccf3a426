#pragma once

#include <string>

#include "squeal/results/results.hpp"

namespace chladni::report {

/// The speed range in which the brake squeals, for the first line of a page: "squeals from 13.4 to
/// 20.1 rad/s at 1000 Hz", with "on" instead of the end when the range of speeds ends there, and
/// the number of further ranges.
/// @param results  with a critical speed
std::string where_it_squeals(const squeal::SquealResults& results);

/// The title of a motion on the page: "Limit cycle at 18.8 rad/s", or a title that says that the
/// motion has not settled or is not stable.
std::string name_of(const squeal::LimitCycle& cycle);
std::string name_of(const squeal::DirectLimitCycle& cycle);

}  // namespace chladni::report
