#pragma once

#include <vector>

#include "report/json.hpp"
#include "report/output.hpp"
#include "squeal/results/sweep_table.hpp"

namespace chladni::report {

/// What varies and what is found, each from its least to its largest number, and the variants that
/// failed.
TextTable describe(const squeal::SweepTable& sweep);

/// Members `variants`, `done`, `failed` and `failures`, with the reason of each.
std::vector<Json::Member> sweep_json(const squeal::SweepTable& sweep);

}  // namespace chladni::report
