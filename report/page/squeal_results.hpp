#pragma once

#include <vector>

#include "report/json.hpp"
#include "squeal/results/results.hpp"

namespace chladni::report {

/// The results of a study as curves and maps for a page: eigenvalues, critical speed, stability
/// map, envelope, forces, orbit, limit cycles, spectrum, growth. Analyses that were not asked for
/// are absent. Long histories are reduced to the minimum and maximum of windows.
std::vector<Json::Member> squeal_members(const squeal::SquealResults& results);

}  // namespace chladni::report
