#pragma once

#include "squeal/disc.hpp"
#include "squeal/results.hpp"
#include "squeal/squeal_options.hpp"
#include "squeal/transient.hpp"

namespace chladni::squeal {

/// The limit cycles at those of `options.speeds` at which the sliding disc is unstable, each found
/// from its neighbour above; where that is too far, at speeds between the two. The branch ends
/// where the disc becomes stable or the cycle is lost.
/// @return by rising speed, empty when the disc is stable at the highest speed
/// @throws chladni::Error as `limit_cycle_direct` at the highest speed.
LimitCycleBranch limit_cycle_branch(const Disc& disc, const SquealOptions& options,
                                    const Progress& progress = {});

}  // namespace chladni::squeal
