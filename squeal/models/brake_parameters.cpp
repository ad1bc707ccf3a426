#include "squeal/models/brake_parameters.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>

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

constexpr auto k = &Suspension::stiffness, d = &Suspension::damping;

constexpr std::array pad_rows = {
    PadRow{"preload", [](PadPair& pad) { return &pad.preload; }},
    PadRow{"stiffness", [](PadPair& pad) { return &pad.stiffness; }},
    PadRow{"damping", [](PadPair& pad) { return &pad.damping; }},
    PadRow{"pads.angle_deg", [](PadPair& pad) { return &pad.angle; }, std::numbers::pi / 180.0},
    PadRow{"pads.grid.sector_deg",
           [](PadPair& pad) { return pad.grid ? &pad.grid->sector : nullptr; },
           std::numbers::pi / 180.0},
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

double* place_in(SquealOptions& options, std::string_view name)
{
  FrictionLaw& law = options.friction;
  if (name == "friction") return &law.kinetic;
  if (name == "friction.decay_speed") return law.rise > 0.0 ? &law.decay_speed : nullptr;
  if (name == "friction.regularisation") return &law.regularisation;
  return nullptr;
}

}  // namespace

SquealOptions with_parameter(SquealOptions options, MapParameter parameter, double value)
{
  if (parameter.name == "friction.static") {
    FrictionLaw& law = options.friction;
    if (value < law.kinetic) {
      throw Error(
          fmt::format("[squeal] friction.static = {:.6g} is below friction.kinetic = {:.6g}; "
                      "begin the range there",
                      value, law.kinetic));
    }
    set_parameter(law.rise > 0.0 ? &law.rise : nullptr, parameter, value - law.kinetic);
    return options;
  }
  for (const PadRow& row : pad_rows)
    if (row.name == parameter.name) {
      require_one_pad_to_turn(parameter);
      set_parameter(set_in_pads(options, row, parameter.pad, value), parameter, row.unit * value);
      return options;
    }
  double* const at = parameter.name == "thickness" ? set_thickness(options, value)
                                                   : place_in(options, parameter.name);
  set_parameter(at, parameter, value);
  return options;
}

}  // namespace chladni::squeal
