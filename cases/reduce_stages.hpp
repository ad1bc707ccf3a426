#pragma once

#include <vector>

#include "reduce/reduce_options.hpp"
#include "report/progress.hpp"

namespace chladni::cases {

/// The phases of a reduction in their order, with their usual share of the time, per cent.
std::vector<report::Stage> stages_of(const reduce::ReduceOptions& wanted);

/// The phases of a reduction from one sector, with their usual share of the time, per cent.
std::vector<report::Stage> stages_of_sectors();

}  // namespace chladni::cases
