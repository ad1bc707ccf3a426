#pragma once

#include "squeal/brake/disc.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Most multiples of the frequency of a limit cycle that are computed.
inline constexpr int n_cycle_harmonics = 8;

/// Amplitudes of all multiples of the frequency of a limit cycle, as `LimitCycle::amplitude`:
/// column h - 1 goes with exp(i h omega t), and the largest of the first column is real.
/// @param disc     as the cycle was found with it
/// @param options  likewise
/// @return [n_modes x n_cycle_harmonics] m kg^(1/2)
Eigen::MatrixXcd cycle_harmonics(const Disc& disc, const SquealOptions& options,
                                 const DirectLimitCycle& cycle);

}  // namespace chladni::squeal
