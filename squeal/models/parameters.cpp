#include "squeal/models/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <utility>

#include "common/error.hpp"

namespace chladni::squeal {

namespace {

/// A parameter of pads: where a pad holds it, null for one that has none, and its unit there.
struct PadRow {
  std::string_view name;
  double* (*at)(PadPair& pad);
  double unit = 1.0;
};

template <auto direction, auto value>
double* of_translation(PadPair& pad)
{
  if (!pad.body || !((*pad.body).*direction)) return nullptr;
  return &((*((*pad.body).*direction)).*value);
}

template <auto direction, auto value>
double* of_rotation(PadPair& pad)
{
  if (!pad.body || !((*pad.body).*direction)) return nullptr;
  return &((*((*pad.body).*direction)).suspension.*value);
}

template <auto direction>
double* inertia_of(PadPair& pad)
{
  if (!pad.body || !((*pad.body).*direction)) return nullptr;
  return &(*((*pad.body).*direction)).inertia;
}

template <auto value>
double* of_body(PadPair& pad)
{
  return pad.body ? &((*pad.body).*value) : nullptr;
}

template <auto value>
double* of_caliper(PadPair& pad)
{
  return pad.caliper ? &(pad.caliper->axial.*value) : nullptr;
}

template <auto value>
double* of_shim(PadPair& pad)
{
  return pad.shim ? &((*pad.shim).*value) : nullptr;
}

constexpr auto k = &Suspension::stiffness, d = &Suspension::damping;

constexpr std::array parameters_of_pads = {
    PadRow{"preload", [](PadPair& pad) { return &pad.preload; }},
    PadRow{"stiffness", [](PadPair& pad) { return &pad.stiffness; }},
    PadRow{"damping", [](PadPair& pad) { return &pad.damping; }},
    PadRow{"pads.angle_deg", [](PadPair& pad) { return &pad.angle; }, std::numbers::pi / 180.0},
    PadRow{"pads.grid.sector_deg",
           [](PadPair& pad) { return pad.grid ? &pad.grid->sector : nullptr; },
           std::numbers::pi / 180.0},
    PadRow{"pads.area", [](PadPair& pad) { return pad.area ? &*pad.area : nullptr; }},
    PadRow{"pads.radius",
           [](PadPair& pad) { return pad.radius && *pad.radius > 0.0 ? &*pad.radius : nullptr; }},
    PadRow{"pads.shim.stiffness", of_shim<&Shim::stiffness>},
    PadRow{"pads.shim.loss_factor", of_shim<&Shim::loss_factor>},
    PadRow{"pads.shim.frequency_Hz", of_shim<&Shim::frequency_Hz>},
    PadRow{"pads.body.mass", of_body<&PadBody::mass>},
    PadRow{"pads.body.height", of_body<&PadBody::height>},
    PadRow{"pads.body.radial.stiffness", of_translation<&PadBody::radial, k>},
    PadRow{"pads.body.radial.damping", of_translation<&PadBody::radial, d>},
    PadRow{"pads.body.tangential.stiffness", of_translation<&PadBody::tangential, k>},
    PadRow{"pads.body.tangential.damping", of_translation<&PadBody::tangential, d>},
    PadRow{"pads.body.axial.stiffness", of_translation<&PadBody::axial, k>},
    PadRow{"pads.body.axial.damping", of_translation<&PadBody::axial, d>},
    PadRow{"pads.body.about_radial.inertia", inertia_of<&PadBody::about_radial>},
    PadRow{"pads.body.about_radial.stiffness", of_rotation<&PadBody::about_radial, k>},
    PadRow{"pads.body.about_radial.damping", of_rotation<&PadBody::about_radial, d>},
    PadRow{"pads.body.about_tangential.inertia", inertia_of<&PadBody::about_tangential>},
    PadRow{"pads.body.about_tangential.stiffness", of_rotation<&PadBody::about_tangential, k>},
    PadRow{"pads.body.about_tangential.damping", of_rotation<&PadBody::about_tangential, d>},
    PadRow{"pads.body.about_axial.inertia", inertia_of<&PadBody::about_axial>},
    PadRow{"pads.body.about_axial.stiffness", of_rotation<&PadBody::about_axial, k>},
    PadRow{"pads.body.about_axial.damping", of_rotation<&PadBody::about_axial, d>},
    PadRow{"pads.caliper.mass", [](PadPair& p) { return p.caliper ? &p.caliper->mass : nullptr; }},
    PadRow{"pads.caliper.stiffness", of_caliper<k>},
    PadRow{"pads.caliper.damping", of_caliper<d>},
};

/// In every pad that has it, or in one.
/// @param number  of this one, from 1; 0: every pad
/// @return one of these places; null when no pad has it
double* set_in_pads(SquealOptions& options, const PadRow& row, int number, double value)
{
  double* found = nullptr;
  for (std::size_t i = 0; i < options.pads.size(); ++i) {
    if (number != 0 && i + 1 != static_cast<std::size_t>(number)) continue;
    if (double* const at = row.at(options.pads[i])) *(found = at) = row.unit * value;
  }
  return found;
}

/// At one angle all pads would be in one place.
void require_one_pad_to_turn(MapParameter parameter)
{
  if (parameter.name != "pads.angle_deg" || parameter.pad != 0) return;
  throw Error(
      "[squeal] \"pads.angle_deg\" cannot vary for all pads at once; name one, e.g. "
      "\"pads[2].angle_deg\"");
}

/// Keeps the middle between the contact planes.
double* set_thickness(SquealOptions& options, double value)
{
  if (options.planes && options.planes->heights) {
    auto& [low, high] = *options.planes->heights;
    const double middle = 0.5 * (low + high);
    low = middle - 0.5 * value;
    high = middle + 0.5 * value;
  }
  return &options.thickness;
}

/// One of the heights of the planes, which the distance between them follows.
double* set_plane(SquealOptions& options, std::string_view name, double value)
{
  if (!options.planes || !options.planes->heights) return nullptr;
  auto& heights = *options.planes->heights;
  double& height = heights[name == "contact_planes[1]" ? 0 : 1];
  height = value;
  options.thickness = heights[1] - heights[0];
  return &height;
}

constexpr std::string_view of_brake = "friction", of_pads = "pads.friction";

/// "static" of "friction.static" or "pads.friction.static", "" of the law itself.
std::string_view friction_key(std::string_view name)
{
  name.remove_prefix((name.starts_with(of_pads) ? of_pads : of_brake).size());
  return name.empty() ? name : name.substr(1);
}

/// Laws of the brake or, of all pads or of one, those that they have themselves.
std::vector<FrictionLaw*> laws_of(SquealOptions& options, MapParameter parameter)
{
  if (!parameter.name.starts_with(of_pads)) return {&options.friction};
  std::vector<FrictionLaw*> laws;
  for (std::size_t i = 0; i < options.pads.size(); ++i) {
    if ((parameter.pad == 0 || i + 1 == static_cast<std::size_t>(parameter.pad)) &&
        options.pads[i].friction)
      laws.push_back(&*options.pads[i].friction);
  }
  return laws;
}

SquealOptions with_friction(SquealOptions options, MapParameter parameter, double value)
{
  const std::string_view key = friction_key(parameter.name);
  double set = 0.0, *found = nullptr;
  for (FrictionLaw* law : laws_of(options, parameter)) {
    if (!friction_value(*law, key)) continue;
    *law = with_friction_value(*law, key, value);
    found = &set;
  }
  set_parameter(found, parameter, value);
  return options;
}

/// Adds the parameters of a prefix by which a scene states the law.
/// @param pad  number of the pad, from 1, or 0
void add_said(std::vector<ParameterValue>& values, const FrictionLaw& law, std::string_view prefix,
              int pad)
{
  for (const ParameterRow& row : parameters)
    if (row.name.starts_with(prefix) && is_said_by(law, friction_key(row.name)))
      values.push_back({{row.name, pad}, *friction_value(law, friction_key(row.name))});
}

}  // namespace

SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value)
{
  const std::string_view name = parameter.name;
  if (name.starts_with(of_brake) || name.starts_with(of_pads))
    return with_friction(std::move(options), parameter, value);
  for (const PadRow& row : parameters_of_pads)
    if (row.name == parameter.name) {
      require_one_pad_to_turn(parameter);
      set_parameter(set_in_pads(options, row, parameter.pad, value), parameter, row.unit * value);
      return options;
    }
  set_parameter(
      name == "thickness" ? set_thickness(options, value) : set_plane(options, name, value),
      parameter, value);
  return options;
}

std::vector<ParameterValue> parameter_values(SquealOptions options)
{
  std::vector<ParameterValue> values;
  const auto has_its_own = [](const PadPair& pad) { return pad.friction.has_value(); };
  if (!std::ranges::all_of(options.pads, has_its_own))
    values = friction_parameters(options.friction);
  if (options.planes && options.planes->heights) {
    values.push_back({{"contact_planes[1]"}, (*options.planes->heights)[0]});
    values.push_back({{"contact_planes[2]"}, (*options.planes->heights)[1]});
  } else {
    values.push_back({{"thickness"}, options.thickness});
  }
  for (std::size_t i = 0; i < options.pads.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    for (const PadRow& row : parameters_of_pads)
      if (const double* const at = row.at(options.pads[i]))
        values.push_back({{row.name, number}, *at / row.unit});
    if (options.pads[i].friction) add_said(values, *options.pads[i].friction, of_pads, number);
  }
  return values;
}

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

bool is_of_law(MapParameter parameter)
{
  return parameter.name.starts_with(of_brake);
}

FrictionLaw with_friction_parameter(const FrictionLaw& law, MapParameter parameter, double value)
{
  double set = value;
  const std::string_view key = friction_key(parameter.name);
  const bool has = friction_value(law, key).has_value() && parameter.pad == 0;
  set_parameter(has ? &set : nullptr, parameter, value);
  return with_friction_value(law, key, value);
}

std::vector<ParameterValue> friction_parameters(const FrictionLaw& law)
{
  std::vector<ParameterValue> values;
  add_said(values, law, of_brake, 0);
  return values;
}

std::vector<FrictionNumber> friction_numbers(const FrictionLaw& law, const std::string& key)
{
  std::vector<FrictionNumber> numbers;
  for (const ParameterRow& row : parameters) {
    if (!row.name.starts_with(of_brake)) continue;
    const std::string_view name = friction_key(row.name);
    if (!is_said_by(law, name)) continue;
    numbers.push_back(
        {.key = name.empty() ? key : fmt::format("{}.{}", key, name),
         .unit = row.unit,
         .value = *friction_value(law, name),
         .with = [law, name](double value) { return with_friction_value(law, name, value); }});
  }
  return numbers;
}

}  // namespace chladni::squeal
