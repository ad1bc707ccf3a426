#pragma once

#include <vector>

#include "squeal/parameter_options.hpp"
#include "squeal/squeal_options.hpp"

namespace chladni::squeal {

/// The options with another value of one parameter; a pad parameter is set for every pad that has
/// it unless it names one pad.
/// @throws chladni::Error when the brake does not have the parameter.
SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value);

/// All parameters that may affect small motions, by their keys in the scene; pad parameters are
/// listed for each pad pair. Cubic springs do not affect small motions and are not listed.
std::vector<ParameterValue> parameter_values(SquealOptions options);

}  // namespace chladni::squeal
