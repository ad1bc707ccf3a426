#pragma once

#include "report/json.hpp"
#include "report/output.hpp"
#include "squeal/results/gradient_results.hpp"

namespace chladni::report {

/// What a change of each number by one per cent does, the largest effects first, 20 at most.
TextTable gradients_table(const squeal::Gradients& gradients);

/// Rows of a table of quantities: the largest effects.
void add_gradients(TextTable& table, const squeal::Gradients& gradients);

Json gradients_json(const squeal::Gradients& gradients);

}  // namespace chladni::report
