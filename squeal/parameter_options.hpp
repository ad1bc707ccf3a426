#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace chladni::squeal {

/// A scalar key of [squeal] that a study may vary, for all pads or for one pad pair.
struct MapParameter {
  std::string_view name;  ///< name of its row in `parameters`
  int pad = 0;            ///< number of the pad pair, from 1; 0: all pairs

  static const MapParameter friction;   ///< mu
  static const MapParameter preload;    ///< N_0 of every pad, N
  static const MapParameter stiffness;  ///< k of every pad, N/m
  static const MapParameter damping;    ///< d of every pad, N s/m

  bool operator==(const MapParameter&) const = default;
};
inline constexpr MapParameter MapParameter::friction{"friction"};
inline constexpr MapParameter MapParameter::preload{"preload"};
inline constexpr MapParameter MapParameter::stiffness{"stiffness"};
inline constexpr MapParameter MapParameter::damping{"damping"};

/// The kinds of brakes that have a parameter.
enum class ParameterOf { any, body, rigid_disc, oscillator, two_masses, tilting_block };

/// A parameter with its unit and range.
struct ParameterRow {
  std::string_view name;  ///< key in [squeal]; the first four omit the `pads.` of a pad parameter
  std::string_view unit;  ///< of the value
  bool may_be_zero = false;
  ParameterOf of = ParameterOf::body;
};

/// All parameters that a study may vary.
inline constexpr std::array parameters = {
    ParameterRow{"friction", "1", true, ParameterOf::any},
    ParameterRow{"preload", "N", false, ParameterOf::any},
    ParameterRow{"stiffness", "N/m", false, ParameterOf::any},
    ParameterRow{"damping", "N s/m", true, ParameterOf::any},
    ParameterRow{"thickness", "m"},
    ParameterRow{"contact_planes[1]", "m", true},
    ParameterRow{"contact_planes[2]", "m", true},
    ParameterRow{"friction.kinetic", "1", true},
    ParameterRow{"friction.static", "1", true},
    ParameterRow{"friction.decay_speed", "m/s"},
    ParameterRow{"friction.regularisation", "m/s", true},
    ParameterRow{"friction.temperature_C", "degrees Celsius", true},
    ParameterRow{"friction.factor", "1", true},
    ParameterRow{"pads.friction", "1", true},
    ParameterRow{"pads.friction.kinetic", "1", true},
    ParameterRow{"pads.friction.static", "1", true},
    ParameterRow{"pads.friction.decay_speed", "m/s"},
    ParameterRow{"pads.friction.regularisation", "m/s", true},
    ParameterRow{"pads.friction.temperature_C", "degrees Celsius", true},
    ParameterRow{"pads.friction.factor", "1", true},
    ParameterRow{"pads.area", "m^2"},
    ParameterRow{"pads.radius", "m"},
    ParameterRow{"pads.shim.stiffness", "N/m"},
    ParameterRow{"pads.shim.loss_factor", "1", true},
    ParameterRow{"pads.shim.frequency_Hz", "Hz"},
    ParameterRow{"pads.angle_deg", "degrees", true},
    ParameterRow{"pads.grid.sector_deg", "degrees"},
    ParameterRow{"pads.body.mass", "kg"},
    ParameterRow{"pads.body.height", "m", true},
    ParameterRow{"pads.body.radial.stiffness", "N/m"},
    ParameterRow{"pads.body.radial.damping", "N s/m", true},
    ParameterRow{"pads.body.tangential.stiffness", "N/m"},
    ParameterRow{"pads.body.tangential.damping", "N s/m", true},
    ParameterRow{"pads.body.axial.stiffness", "N/m"},
    ParameterRow{"pads.body.axial.damping", "N s/m", true},
    ParameterRow{"pads.body.about_radial.inertia", "kg m^2"},
    ParameterRow{"pads.body.about_radial.stiffness", "N m"},
    ParameterRow{"pads.body.about_radial.damping", "N m s", true},
    ParameterRow{"pads.body.about_tangential.inertia", "kg m^2"},
    ParameterRow{"pads.body.about_tangential.stiffness", "N m"},
    ParameterRow{"pads.body.about_tangential.damping", "N m s", true},
    ParameterRow{"pads.body.about_axial.inertia", "kg m^2"},
    ParameterRow{"pads.body.about_axial.stiffness", "N m"},
    ParameterRow{"pads.body.about_axial.damping", "N m s", true},
    ParameterRow{"pads.caliper.mass", "kg"},
    ParameterRow{"pads.caliper.stiffness", "N/m"},
    ParameterRow{"pads.caliper.damping", "N s/m", true},
    ParameterRow{"rigid_disc.diametral_inertia", "kg m^2", false, ParameterOf::rigid_disc},
    ParameterRow{"rigid_disc.axial_inertia", "kg m^2", false, ParameterOf::rigid_disc},
    ParameterRow{"rigid_disc.stiffness", "N m", false, ParameterOf::rigid_disc},
    ParameterRow{"rigid_disc.damping", "N m s", true, ParameterOf::rigid_disc},
    ParameterRow{"rigid_disc.pad_radius", "m", false, ParameterOf::rigid_disc},
    ParameterRow{"oscillator.mass", "kg", false, ParameterOf::oscillator},
    ParameterRow{"oscillator.stiffness_along", "N/m", false, ParameterOf::oscillator},
    ParameterRow{"oscillator.stiffness_normal", "N/m", false, ParameterOf::oscillator},
    ParameterRow{"oscillator.stiffness_coupling", "N/m", true, ParameterOf::oscillator},
    ParameterRow{"oscillator.damping_along", "N s/m", true, ParameterOf::oscillator},
    ParameterRow{"oscillator.damping_normal", "N s/m", true, ParameterOf::oscillator},
    ParameterRow{"oscillator.contact_stiffness", "N/m", false, ParameterOf::oscillator},
    ParameterRow{"oscillator.preload", "N", false, ParameterOf::oscillator},
    ParameterRow{"oscillator.radius", "m", false, ParameterOf::oscillator},
    ParameterRow{"two_masses.pad_mass", "kg", false, ParameterOf::two_masses},
    ParameterRow{"two_masses.pad_stiffness", "N/m", false, ParameterOf::two_masses},
    ParameterRow{"two_masses.pad_damping", "N s/m", true, ParameterOf::two_masses},
    ParameterRow{"two_masses.disc_mass", "kg", false, ParameterOf::two_masses},
    ParameterRow{"two_masses.disc_stiffness", "N/m", false, ParameterOf::two_masses},
    ParameterRow{"two_masses.disc_damping", "N s/m", true, ParameterOf::two_masses},
    ParameterRow{"two_masses.preload", "N", false, ParameterOf::two_masses},
    ParameterRow{"two_masses.radius", "m", false, ParameterOf::two_masses},
    ParameterRow{"tilting_block.mass", "kg", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.inertia", "kg m^2", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.stiffness_along", "N/m", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.stiffness_normal", "N/m", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.stiffness_tilting", "N m", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.damping_along", "N s/m", true, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.damping_normal", "N s/m", true, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.damping_tilting", "N m s", true, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.height", "m", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.foot_length", "m", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.foot_offset", "m", true, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.contact_stiffness", "N/m", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.preload", "N", false, ParameterOf::tilting_block},
    ParameterRow{"tilting_block.radius", "m", false, ParameterOf::tilting_block},
};

/// A parameter of a brake and its value.
struct ParameterValue {
  MapParameter parameter;
  double value;  ///< in the unit of its row
};

/// The row with this name; null for an unknown name.
constexpr const ParameterRow* find_parameter(std::string_view name)
{
  for (const ParameterRow& row : parameters)
    if (row.name == name) return &row;
  return nullptr;
}

/// The key of a parameter: its name, or "pads[2].stiffness" for one pad pair.
std::string key_of(MapParameter parameter);

/// The parameter with this key (inverse of `key_of`); absent for an unknown key.
std::optional<MapParameter> parameter_of(std::string_view key);

/// Sets the value that `at` points to.
/// @param at  null when the brake does not have the parameter
/// @throws chladni::Error when `at` is null, with the parameter and what to do.
void set_parameter(double* at, MapParameter parameter, double value);

}  // namespace chladni::squeal
