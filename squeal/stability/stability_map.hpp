#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// Least stable eigenvalues of the brake over the speeds and the parameter of `range`.
/// @param n_threads  0: as many as processors; the result does not depend on it
StabilityMap stability_map(const Brake& brake, const MapCase& range, const SpeedRange& speeds,
                           unsigned n_threads = 0);

}  // namespace chladni::squeal
