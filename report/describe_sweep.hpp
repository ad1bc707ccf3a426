#pragma once

#include <vector>

#include "report/json.hpp"
#include "report/output.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::report {

/// A table of varied keys and results with the minimum and maximum of each, followed by the failed
/// variants.
TextTable describe(const squeal::SweepTable& sweep);

/// JSON members `variants`, `done`, `failed`, and `failures` with their reasons.
std::vector<Json::Member> sweep_json(const squeal::SweepTable& sweep);

}  // namespace chladni::report
