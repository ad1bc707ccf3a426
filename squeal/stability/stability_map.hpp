#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/results/results.hpp"
#include "squeal/study_options.hpp"

namespace chladni::squeal {

/// The least stable eigenvalues of the brake over the speeds and over the parameter of `range`, on
/// `n_threads` threads (0: as many as processors). The result does not depend on their number.
StabilityMap stability_map(const Brake& brake, const MapCase& range, const SpeedRange& speeds,
                           unsigned n_threads = 0);

}  // namespace chladni::squeal
