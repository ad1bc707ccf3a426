#include <array>
#include <string_view>

#include "scene/keys.hpp"
#include "squeal/parameter_options.hpp"
#include "squeal/study_options.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible speed =
    usually(positive("rad/s"), 2e3, "it is in rad/s, and a wheel turns at 2 to 200; is it in rpm?");
constexpr Admissible speed_rpm = usually(positive("rpm"), 2e4, "a wheel turns at 20 to 2000 rpm");
constexpr Admissible speed_km_h = usually(positive("km/h"), 600.0, "squeal is heard below 50 km/h");
constexpr std::string_view separator = " | ";

template <class Rows>
constexpr std::size_t length_of_names(const Rows& rows)
{
  std::size_t n = (rows.size() - 1) * separator.size();
  for (const auto& row : rows) n += row.name.size();
  return n;
}

/// The names of all rows: a key has a view of its words alone.
template <std::size_t length, class Rows>
constexpr std::array<char, length> joined_names(const Rows& rows)
{
  std::array<char, length> text{};
  std::size_t at = 0;
  for (const auto& row : rows) {
    if (at > 0)
      for (const char letter : separator) text[at++] = letter;
    for (const char letter : row.name) text[at++] = letter;
  }
  return text;
}

constexpr auto analysis_names = joined_names<length_of_names(squeal::analyses)>(squeal::analyses);
constexpr std::string_view analysis_words(analysis_names.data(), analysis_names.size());
constexpr auto parameter_names =
    joined_names<length_of_names(squeal::parameters)>(squeal::parameters);
constexpr std::string_view parameter_words(parameter_names.data(), parameter_names.size());

constexpr Key squeal_rows[] = {
    {"squeal", table, "not asked for",
     "what `squeal run` does, [squeal](../explanation/squeal.md)"},
    {"squeal.model", word, "flexible disc",
     "the others need no mesh; an assembly takes [bodies of other "
     "scenes](../how-to/several_bodies.md)",
     no_number, "flexible disc | rigid disc | oscillator | two masses | tilting block | assembly"},
    {"squeal.ring", text, "required",
     "ring of the mesh on which the pads rub; or "
     "[two](../explanation/squeal_models.md#two-contact-planes)"},
    {"squeal.ring.inboard", text, "required", "ring of one of the two contact planes"},
    {"squeal.ring.outboard", text, "required", "ring of the other"},
    {"squeal.contact_planes", numbers,
     "half of thickness on both sides of the ring, or of the middle of two",
     "z of the lower and the upper contact plane; instead of thickness",
     usually(in("m"), 1.0, "it is in m; is it in mm?")},
    {"squeal.slopes_from", texts, "rotations of the ring's nodes",
     "rings beside it, at its height, whose displacements give radial slopes"},
    {"squeal.thickness", number, "or contact_planes", "distance of the two contact planes",
     usually(positive("m"), 1.0, "it is in m; is it in mm?")},
    {"squeal.use_modes", text, "all", "\"all\", \"nodal-diameters N\", or a list of mode numbers",
     at_least(1)},
    {"squeal.quasi_static_above_Hz", number, "the body's range",
     "modes of higher frequency, of every kind, follow the pads without inertia; without it "
     "interface modes do, and what a reduction by tolerance has beyond its range: the disc has no "
     "such frequency; with use_modes = \"all\"",
     positive()},
    {"squeal.speeds", table, "required", "rotation speeds, equally spaced"},
    {"squeal.speeds.from_rad_s", number, "or from_rpm, from_km_h", "the lowest", speed},
    {"squeal.speeds.to_rad_s", number, "or to_rpm, to_km_h", "the highest", speed},
    {"squeal.speeds.from_rpm", number, "or from_rad_s", "the lowest", speed_rpm},
    {"squeal.speeds.to_rpm", number, "or to_rad_s", "the highest", speed_rpm},
    {"squeal.speeds.from_km_h", number, "or from_rad_s", "the lowest, with wheel_radius",
     speed_km_h},
    {"squeal.speeds.to_km_h", number, "or to_rad_s", "the highest, with wheel_radius", speed_km_h},
    {"squeal.speeds.wheel_radius", number, "speeds on the road are not told",
     "of the wheel that rolls with the disc",
     usually(positive("m"), 3.0, "it is in m; is it in mm?")},
    {"squeal.speeds.count", integer, "required", "how many", from_to(1, 1e6)},
    {"squeal.analyses", texts, "required", "one behind the other", no_number, analysis_words},
    {"squeal.transient", table, "for transient, limit-cycle", "a run from a small disturbance"},
    {"squeal.transient.speed_rad_s", number, "required", "rotation speed", speed},
    {"squeal.transient.duration_s", number, "required", "time simulated", positive("s")},
    {"squeal.transient.initial_pad_displacement", number, "required", "the disturbance",
     positive("m")},
    {"squeal.transient.steps_per_period", integer, "from growth_error_1_s",
     "of the highest frequency", at_least(8)},
    {"squeal.transient.integrator", word, "auto", "how it is integrated", no_number,
     "auto | splitting | exponential | dormand-prince | generalised-alpha"},
    {"squeal.transient.growth_error_1_s", number, "1e-3",
     "that the integration may add to a growth rate", positive("1/s")},
    {"squeal.transient.speed_program", tables, "constant speed",
     "[speeds to follow](../explanation/squeal_models.md)"},
    {"squeal.transient.speed_program.t_s", number, "required", "ascending", in("s")},
    {"squeal.transient.speed_program.speed_rad_s", number, "required", "speed at that time",
     not_negative("rad/s")},
    {"squeal.transient.preload_program", tables, "constant preload",
     "[preloads to follow](../explanation/squeal_models.md#programs)"},
    {"squeal.transient.preload_program.t_s", number, "required", "ascending", not_negative("s")},
    {"squeal.transient.preload_program.factor", number, "required",
     "of the preload of all pads at that time", not_negative()},
    {"squeal.growth", table, "for growth", "growth rates measured in transients"},
    {"squeal.growth.speeds_rad_s", numbers, "required", "rotation speeds", speed},
    {"squeal.growth.duration_s", number, "required", "of each", positive("s")},
    {"squeal.limit_cycle_direct", table, "speed of the transient",
     "a periodic motion without a transient"},
    {"squeal.limit_cycle_direct.speed_rad_s", number, "required", "rotation speed", speed},
    {"squeal.rotation_stability", table, "hill", "how rotation-stability finds its growth rates"},
    {"squeal.rotation_stability.method", word, "required",
     "by harmonics of the rotation, or by integration over one rotation, the slow reference",
     no_number, "hill | floquet"},
    {"squeal.asymmetry", word, "averaged",
     "small differences within pairs of modes: [of damping](../how-to/damping.md#pairs) and of "
     "frequency",
     no_number, "averaged | kept"},
    {"squeal.gradients", table, "of the critical speed alone",
     "[what to change](../explanation/squeal.md#what-to-change)"},
    {"squeal.gradients.speed_rad_s", number, "required", "of the growth rates", speed},
    {"squeal.map", table, "for stability-map", "growth over the speeds and one more parameter"},
    {"squeal.map.parameter", word, "required",
     "those of pads are of all pads; of one pad alone: pads[2].stiffness, pads[2].angle_deg, ...",
     no_number, parameter_words},
    {"squeal.map.from", number, "required", "in the unit of the parameter", not_negative()},
    {"squeal.map.to", number, "required", "as from", not_negative()},
    {"squeal.map.count", integer, "required", "values of the parameter", from_to(1, 1e6)},
    {"squeal.stability", table, "over the speeds, all frequencies",
     "the modes of the table of `stability`"},
    {"squeal.stability.band_Hz", numbers, "all frequencies",
     "begin and end, up to the highest mode of the body", not_negative("Hz")},
    {"squeal.stability.over", word, "speed", "or any parameter of squeal.map"},
    {"squeal.stability.from", number, "required unless over the speeds",
     "rad/s, or in the unit of the parameter", not_negative()},
    {"squeal.stability.to", number, "with from", "as from", positive()},
    {"squeal.stability.count", integer, "with from", "values that the results hold",
     from_to(2, 1e5)},
    {"squeal.stability.speed_rad_s", number, "required unless over the speed", "rotation speed",
     speed},
    {"squeal.critical", tables, "for critical-values", "searches for the limit of stability"},
    {"squeal.critical.parameter", word, "required", "any of squeal.map"},
    {"squeal.critical.from", number, "required", "in the unit of the parameter", positive()},
    {"squeal.critical.to", number, "required", "as from", positive()},
    {"squeal.critical.speed_rad_s", number, "required", "rotation speed", speed},
    {"squeal.radiation", truth, "false",
     "damps the modes by the sound that they radiate, from `chladni sound`"},
    {"squeal.wav", table, "none", "pad velocity of the transient as sound, NAME.wav"},
    {"squeal.wav.rate_Hz", integer, "required", "of the samples", from_to(8000.0, 192000.0, "Hz")},
};

}  // namespace

std::span<const Key> squeal_keys()
{
  return squeal_rows;
}

}  // namespace chladni::scene
