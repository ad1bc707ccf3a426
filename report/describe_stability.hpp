#pragma once

#include <string>

#include "report/json.hpp"
#include "report/output.hpp"
#include "squeal/results/stability_table.hpp"

namespace chladni::report {

/// Adds the number of unstable modes, then a row for each by ascending frequency: its unstable
/// interval, growth rate with its error and damping ratio at the largest growth, and the modes that
/// take part there.
void add_unstable_modes(TextTable& table, const squeal::StabilityTable& stability);

/// The known parts of an error in words, such as "mesh 0.1, reduction 2e-09".
std::string parts_of(const squeal::ErrorBudget& budget);

/// JSON of the parts of an error; null where they are unknown.
Json budget_json(const squeal::ErrorBudget& budget);

/// JSON of all branches over all values of the parameter, with their unstable intervals and
/// participating modes.
Json stability_table_json(const squeal::StabilityTable& stability);

}  // namespace chladni::report
