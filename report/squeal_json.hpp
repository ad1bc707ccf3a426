#pragma once

#include <vector>

#include "report/json.hpp"
#include "squeal/results/results.hpp"

namespace chladni::report {

/// What `squeal run --json` says of the results:
/// only what was asked for; `critical_speed_rad_s` is null when there is none in the range.
std::vector<Json::Member> results_json(const squeal::SquealResults& results);

}  // namespace chladni::report
