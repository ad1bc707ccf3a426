#pragma once

#include "squeal/models/brake.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// Estimated errors of frequency and amplitudes of a limit cycle. The part of the integration is
/// the difference to the same cycle at a thousandth of the tolerance, with twice the samples. The
/// parts of the body are those of its modes (stability/errors_by_modes.hpp) times the derivatives
/// of the cycle by frequencies and ring motions, from the linearised equations of harmonic balance.
/// The part of the modes left out is the difference to the cycle of all modes by three harmonics.
/// @param cycle  of this brake
CycleErrors cycle_errors(const Brake& brake, const DirectLimitCycle& cycle);

}  // namespace chladni::squeal
