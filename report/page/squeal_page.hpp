#pragma once

#include <string>
#include <vector>

#include "report/json.hpp"
#include "report/page/body_page.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::report {

/// What a study found, as the curves and maps of a page: eigenvalues, critical speed, stability
/// map, envelope, forces, orbit, limit cycles, spectrum, growth. What was not asked for is absent.
/// Long histories are thinned to the smallest and largest values of windows.
/// @param looks  of the modes of the body; empty without one
std::vector<Json::Member> squeal_members(const squeal::SquealResults& results,
                                         const ModeLooks& looks);

/// The motions found by a study: the limit cycle and the least stable oscillation.
/// @param mode_numbers  1-based numbers in the body of the modes that the study used
/// @param n_modes       number of modes of the body
std::vector<Motion> squeal_motions(const squeal::SquealResults& results,
                                   const std::vector<int>& mode_numbers, Eigen::Index n_modes);

/// The speed range in which the brake squeals, for the first line of a page: "squeals from 13.4 to
/// 20.1 rad/s at 1000 Hz", with "on" instead of the end when the range of speeds ends there, and
/// the number of further ranges.
/// @param results  with a critical speed
std::string where_it_squeals(const squeal::SquealResults& results);

/// The title of a motion on the page: "Limit cycle at 18.8 rad/s", or a title that says that the
/// motion has not settled or is not stable.
std::string name_of(const squeal::LimitCycle& cycle);
std::string name_of(const squeal::DirectLimitCycle& cycle);

}  // namespace chladni::report
