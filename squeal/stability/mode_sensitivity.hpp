#pragma once

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Which modes decide about the critical speed: it with the lowest 2, 8, 16 and all modes, and how
/// it and the growth rate there change when one mode or pair of modes is left out.
/// @throws chladni::Error when there is no critical speed in the range.
ModeSensitivity mode_sensitivity(const InertialDisc& disc, const SquealOptions& options);

}  // namespace chladni::squeal
