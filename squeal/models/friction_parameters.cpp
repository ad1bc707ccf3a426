#include "squeal/models/friction_parameters.hpp"

#include <fmt/format.h>

#include "common/error.hpp"

namespace chladni::squeal {

std::optional<double> friction_value(const FrictionLaw& law, std::string_view key)
{
  const auto given = [](bool has, double value) {
    return has ? std::optional(value) : std::nullopt;
  };
  const bool varies = law.rise != 0.0, is_measured = law.table != nullptr;
  if (key.empty()) return law.kinetic;
  if (key == "kinetic") return given(!is_measured, law.kinetic);
  if (key == "static") return given(varies, law.kinetic + law.rise);
  if (key == "decay_speed") return given(varies, law.decay_speed);
  if (key == "regularisation") return law.regularisation;
  if (key == "temperature_C")
    return given(is_measured && law.table->temperatures.size() > 1, law.temperature);
  return given(key == "factor" && is_measured, law.kinetic);
}

FrictionLaw with_friction_value(FrictionLaw law, std::string_view key, double value)
{
  const double at_rest = law.kinetic + law.rise;
  if (key.empty() || key == "factor") {
    law.kinetic = value;
  } else if (key == "kinetic") {
    law.rise = law.rise != 0.0 ? at_rest - value : 0.0;
    law.kinetic = value;
  } else if (key == "static") {
    law.rise = value - law.kinetic;
  } else if (key == "decay_speed") {
    law.decay_speed = value;
  } else if (key == "regularisation") {
    law.regularisation = value;
  } else {
    law.temperature = value;
  }
  if (law.rise < 0.0 && law.kinetic + law.rise < 0.0) {
    throw Error(
        fmt::format("[squeal] friction = {:.6g} makes friction.static {:.6g}, which must not be "
                    "negative; begin the range at {:.6g}",
                    law.kinetic, law.kinetic + law.rise, -law.rise));
  }
  return law;
}

bool is_said_by(const FrictionLaw& law, std::string_view key)
{
  const bool is_number = !law.table && law.rise == 0.0 && law.regularisation == 0.0;
  if (is_number != key.empty()) return false;
  if (key == "regularisation") return law.regularisation > 0.0;
  return friction_value(law, key).has_value();
}

namespace {

constexpr std::string_view of_brake = "friction";

std::string_view key_within(std::string_view name)
{
  name.remove_prefix(of_brake.size());
  return name.empty() ? name : name.substr(1);
}

}  // namespace

bool is_of_law(MapParameter parameter)
{
  return parameter.name.starts_with(of_brake);
}

FrictionLaw with_friction_parameter(const FrictionLaw& law, MapParameter parameter, double value)
{
  double set = value;
  const std::string_view key = key_within(parameter.name);
  const bool has = friction_value(law, key).has_value() && parameter.pad == 0;
  set_parameter(has ? &set : nullptr, parameter, value);
  return with_friction_value(law, key, value);
}

std::vector<ParameterValue> friction_parameters(const FrictionLaw& law)
{
  std::vector<ParameterValue> values;
  for (const ParameterRow& row : parameters) {
    if (!row.name.starts_with(of_brake) || !is_said_by(law, key_within(row.name))) continue;
    values.push_back({{row.name}, *friction_value(law, key_within(row.name))});
  }
  return values;
}

}  // namespace chladni::squeal
