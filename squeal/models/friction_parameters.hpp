#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "squeal/friction.hpp"
#include "squeal/parameter_options.hpp"

namespace chladni::squeal {

/// The value of a friction law for a key of its table: "kinetic", "static", "decay_speed",
/// "regularisation", "temperature_C" or "factor"; or for the law itself, "", which scales all of
/// mu.
/// @return absent when the law does not have the key
std::optional<double> friction_value(const FrictionLaw& law, std::string_view key);

/// The law with another value of a key that it has. Other keys keep their values; for example
/// "kinetic" does not change "static".
/// @throws chladni::Error when the static coefficient would be negative.
FrictionLaw with_friction_value(FrictionLaw law, std::string_view key, double value);

/// Whether a scene states the law by this key: "" for a single coefficient, the others for a table.
bool is_said_by(const FrictionLaw& law, std::string_view key);

/// Whether a parameter is a key of the brake's friction law, such as "friction" or
/// "friction.static".
bool is_of_law(MapParameter parameter);

/// The law with another value of a parameter for which `is_of_law` holds.
/// @throws chladni::Error when the law does not have the key.
FrictionLaw with_friction_parameter(const FrictionLaw& law, MapParameter parameter, double value);

/// The parameters by which a scene states the friction law of a brake.
std::vector<ParameterValue> friction_parameters(const FrictionLaw& law);

}  // namespace chladni::squeal
