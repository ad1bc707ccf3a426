#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "squeal/friction.hpp"
#include "squeal/parameter_options.hpp"

namespace chladni::squeal {

/// The value that a law of friction has of a key of its table: "kinetic", "static", "decay_speed",
/// "regularisation", "temperature_C" or "factor", or of the law itself, "", which moves all of mu.
/// @return absent where the law has no such key
std::optional<double> friction_value(const FrictionLaw& law, std::string_view key);

/// The law with another value of a key that it has; the others keep theirs, so that "kinetic"
/// leaves "static" where it is.
/// @throws chladni::Error when the static coefficient would be negative.
FrictionLaw with_friction_value(FrictionLaw law, std::string_view key, double value);

/// Whether a scene gives the law by this key: a coefficient alone by "", a table by the others.
bool is_said_by(const FrictionLaw& law, std::string_view key);

/// Whether a parameter is a key of the law of a brake, "friction" or "friction.static".
bool is_of_law(MapParameter parameter);

/// The law with another value of such a parameter.
/// @throws chladni::Error when it has no such key.
FrictionLaw with_friction_parameter(const FrictionLaw& law, MapParameter parameter, double value);

/// The parameters by which a scene gives the law of a brake.
std::vector<ParameterValue> friction_parameters(const FrictionLaw& law);

}  // namespace chladni::squeal
