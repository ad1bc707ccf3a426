#pragma once

#include <vector>

#include "report/page/shapes.hpp"
#include "squeal/results/results.hpp"

namespace chladni::report {

/// The motions found by a study: the limit cycle and the least stable oscillation.
/// @param mode_numbers  1-based numbers in the body of the modes that the study used
/// @param n_modes       number of modes of the body
std::vector<Motion> squeal_motions(const squeal::SquealResults& results,
                                   const std::vector<int>& mode_numbers, Eigen::Index n_modes);

}  // namespace chladni::report
