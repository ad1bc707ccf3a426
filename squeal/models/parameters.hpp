#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "squeal/brake_options.hpp"
#include "squeal/friction.hpp"
#include "squeal/parameter_options.hpp"

namespace chladni::squeal {

/// The options with another value of one parameter; a pad parameter is set for every pad that has
/// it unless it names one pad.
/// @throws chladni::Error when the brake does not have the parameter.
SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value);

/// All parameters that may affect small motions, by their keys in the scene; pad parameters are
/// listed for each pad pair. Cubic springs do not affect small motions and are not listed.
std::vector<ParameterValue> parameter_values(SquealOptions options);

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

/// A number by which a scene gives a friction law.
struct FrictionNumber {
  std::string key;        ///< "friction.static", "contact[2].friction.factor"
  std::string_view unit;  ///< of its value
  double value;
  std::function<FrictionLaw(double value)> with;  ///< the law with another value of this number
};

/// The numbers by which a scene gives a law, `factor` for a table; the points of a table are
/// measured and have no row of their own.
std::vector<FrictionNumber> friction_numbers(const FrictionLaw& law, const std::string& key);

}  // namespace chladni::squeal
