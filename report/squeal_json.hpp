#pragma once

#include <vector>

#include "report/json.hpp"
#include "squeal/results/results.hpp"

namespace chladni::report {

/// JSON members of the results for `squeal run --json`. Only analyses that were asked for are
/// present; `critical_speed_rad_s` is null when there is none in the range.
std::vector<Json::Member> results_json(const squeal::SquealResults& results);

}  // namespace chladni::report
