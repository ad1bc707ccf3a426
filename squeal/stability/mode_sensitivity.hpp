#pragma once

#include "squeal/brake/inertial_frame.hpp"
#include "squeal/results/results.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// Influence of the modes on the critical speed: its values with the lowest 2, 8, 16 and all modes,
/// and its change and the growth rate at it when one mode or pair of modes is left out.
/// @throws chladni::Error when there is no critical speed in the range.
ModeSensitivity mode_sensitivity(const InertialDisc& disc, const SquealOptions& options);

}  // namespace chladni::squeal
