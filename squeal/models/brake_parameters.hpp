#pragma once

#include <vector>

#include "squeal/parameter_options.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The options with one parameter set to `value`, for every pad that has it if it is one of pads.
/// @throws chladni::Error when nothing in the brake has it.
SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value);

/// Every parameter on which small motions may depend, by the keys that a scene gives it, those of
/// pads for each pair by itself. Cubic springs change no small motion and are none.
std::vector<ParameterValue> parameter_values(SquealOptions options);

}  // namespace chladni::squeal
