#pragma once

#include <string>
#include <vector>

#include "cases/reduce_scene.hpp"
#include "report/json.hpp"
#include "report/output.hpp"

namespace chladni::cases {

/// What the reduction was about, beside what the factorisation cost.
report::TextTable reduction_table(const ReduceSummary& summary);

/// That table, and where the method was chosen automatically a line that says why.
std::string described_reduction(const ReduceSummary& summary);

/// Members `n_dofs`, `n_nodes`, `n_masters`, `n_modes`, `certified_frequencies_Hz` with their
/// `eta2`, `factor_wall_s`, `factor_cpu_s`.
std::vector<report::Json::Member> reduction_json(const ReduceSummary& summary);

}  // namespace chladni::cases
