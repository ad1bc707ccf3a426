#pragma once

#include "squeal/parameter_options.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The options with one parameter set to `value`, for every pad that has it if it is one of pads.
/// @throws chladni::Error when nothing in the brake has it.
SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value);

}  // namespace chladni::squeal
