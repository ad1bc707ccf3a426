#pragma once

#include "squeal/brake/disc.hpp"
#include "squeal/brake_options.hpp"
#include "squeal/results/squeal_results.hpp"

namespace chladni::squeal {

/// Number of harmonics computed by cycle_harmonics.
inline constexpr int n_cycle_harmonics = 8;

/// Complex amplitudes of the harmonics of a limit cycle, as in `LimitCycle::amplitude`. Column
/// h - 1 belongs to exp(i h omega t), and the largest entry of the first column is real.
/// @param disc     disc with which the cycle was found
/// @param options  options with which the cycle was found
/// @return [n_modes x n_cycle_harmonics] m kg^(1/2)
Eigen::MatrixXcd cycle_harmonics(const Disc& disc, const SquealOptions& options,
                                 const DirectLimitCycle& cycle);

}  // namespace chladni::squeal
