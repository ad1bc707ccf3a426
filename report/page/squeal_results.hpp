#pragma once

#include <vector>

#include "report/json.hpp"
#include "report/page/mode_looks.hpp"
#include "squeal/results/results.hpp"

namespace chladni::report {

/// What a study found, as the curves and maps of a page: eigenvalues, critical speed, stability
/// map, envelope, forces, orbit, limit cycles, spectrum, growth. What was not asked for is absent.
/// Long histories are thinned to the smallest and largest values of windows.
/// @param looks  of the modes of the body; empty without one
std::vector<Json::Member> squeal_members(const squeal::SquealResults& results,
                                         const ModeLooks& looks);

}  // namespace chladni::report
