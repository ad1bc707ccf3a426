#pragma once

#include "report/json.hpp"
#include "report/output.hpp"
#include "squeal/results/gradient_results.hpp"

namespace chladni::report {

/// The change of each result when a number changes by one per cent, the largest effects first.
TextTable gradients_table(const squeal::Gradients& gradients);

/// Adds the rows with the largest effects, at most 20, to a table of quantities.
void add_gradients(TextTable& table, const squeal::Gradients& gradients);

/// The gradients as JSON.
Json gradients_json(const squeal::Gradients& gradients);

}  // namespace chladni::report
