#pragma once

#include <string>
#include <vector>

#include "cases/reduce_scene.hpp"
#include "report/json.hpp"
#include "report/text_table.hpp"

namespace chladni::cases {

/// A table of the sizes of a reduction and the cost of its factorisation.
report::TextTable reduction_table(const ReduceSummary& summary);

/// The table of `reduction_table`, and a line with the reason if the method was chosen
/// automatically.
std::string described_reduction(const ReduceSummary& summary);

/// The JSON members `n_dofs`, `n_nodes`, `n_masters`, `n_modes`, `certified_frequencies_Hz` with
/// their `eta2`, `factor_wall_s`, `factor_cpu_s`.
std::vector<report::Json::Member> reduction_json(const ReduceSummary& summary);

}  // namespace chladni::cases
