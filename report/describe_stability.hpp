#pragma once

#include "report/json.hpp"
#include "report/output.hpp"
#include "squeal/results/stability_table.hpp"

namespace chladni::report {

/// The row that counts the unstable modes, then one for each of them by rising frequency: where it
/// is unstable, its growth and damping ratio where it grows most, and what takes part in it there.
void add_unstable_modes(TextTable& table, const squeal::StabilityTable& stability);

/// All branches over all values, with their intervals and what takes part in them.
Json stability_table_json(const squeal::StabilityTable& stability);

}  // namespace chladni::report
