#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible force{.above = 0.0, .unit = "N"};
constexpr Admissible mass{.above = 0.0, .unit = "kg"};
constexpr Admissible length{.above = 0.0, .unit = "m"};
constexpr Admissible spring{.above = 0.0, .unit = "N/m"};
constexpr Admissible damper{.at_least = 0.0, .unit = "N s/m"};
constexpr Admissible inertia{.above = 0.0, .unit = "kg m^2"};

constexpr Admissible friction{
    .at_least = 0.0, .usual_to = 2.0, .usually = "it is a pure number, of linings 0.2 to 0.7"};

constexpr Key brake_rows[] = {
    {"squeal.friction", number, "required",
     "coefficient of Coulomb; or a [table](squeal_models.md)", friction},
    {"squeal.friction.kinetic", number, "required", "of fast sliding", friction},
    {"squeal.friction.static",
     number,
     "kinetic",
     "of slow sliding, at least the kinetic one",
     {.at_least = 0.0}},
    {"squeal.friction.decay_speed",
     number,
     "required with static",
     "of the rise towards rest",
     {.above = 0.0, .unit = "m/s"}},
    {"squeal.friction.regularisation",
     number,
     "0",
     "width of the change of direction",
     {.above = 0.0, .unit = "m/s"}},
    {"squeal.contact",
     word,
     "unilateral",
     "what a pad does that would have to pull",
     {},
     "unilateral | bilateral | signed"},
    {"squeal.pads", tables, "required", "pad pairs; the rigid disc has one, the oscillator none"},
    {"squeal.pads.angle_deg",
     number,
     "required",
     "of the pair in the inertial frame",
     {.unit = "degrees"}},
    {"squeal.pads.stiffness", number, "required", "of each pad", spring},
    {"squeal.pads.damping", number, "required", "of each pad", damper},
    {"squeal.pads.preload", number, "required", "of each pad", force},
    {"squeal.pads.cubic_stiffness", number, "0", "of each pad", {.at_least = 0.0, .unit = "N/m^3"}},
    {"squeal.pads.grid", table, "one point", "point contacts over a sector"},
    {"squeal.pads.grid.sector_deg",
     number,
     "required",
     "angle that the points cover",
     {.above = 0.0, .at_most = 360.0, .unit = "degrees"}},
    {"squeal.pads.grid.points", integer, "required", "how many", {.at_least = 1, .at_most = 1e4}},
    {"squeal.pads.grid.rings", texts, "the ring of the study",
     "rings that share the points; pairs of them where `ring` is one"},
    {"squeal.pads.grid.rings.inboard", text, "required", "of a pair"},
    {"squeal.pads.grid.rings.outboard", text, "required", "of a pair"},
    {"squeal.pads.body", table, "massless", "each plate as a rigid body; needs a suspension"},
    {"squeal.pads.body.mass", number, "required", "of each plate", mass},
    {"squeal.pads.body.height",
     number,
     "0",
     "of its centre of mass above the contact plane",
     {.at_least = 0.0, .unit = "m"}},
    {"squeal.pads.body.radial", table, "guided", "suspension; so `tangential` and `axial`"},
    {"squeal.pads.body.tangential", table, "guided", "suspension"},
    {"squeal.pads.body.axial", table, "guided", "suspension"},
    {"squeal.pads.body.about_radial", table, "guided",
     "suspension of a rotation; so the other two"},
    {"squeal.pads.body.about_tangential", table, "guided", "suspension of a rotation"},
    {"squeal.pads.body.about_axial", table, "guided", "suspension of a rotation"},
    {"squeal.pads.body.*.stiffness",
     number,
     "required",
     "N/m, or N m of a rotation",
     {.above = 0.0}},
    {"squeal.pads.body.*.damping",
     number,
     "required",
     "N s/m, or N m s of a rotation",
     {.at_least = 0.0}},
    {"squeal.pads.body.*.inertia", number, "required for a rotation",
     "of the plate about that axis", inertia},
    {"squeal.pads.caliper", table, "none", "a body between the axial suspensions and the ground"},
    {"squeal.pads.caliper.mass", number, "required", "of the caliper", mass},
    {"squeal.pads.caliper.stiffness", number, "required", "to the ground", spring},
    {"squeal.pads.caliper.damping", number, "required", "to the ground", damper},
    {"squeal.rigid_disc", table, "for the rigid disc", "[rigid disc](rigid_disc.md)"},
    {"squeal.rigid_disc.diametral_inertia", number, "required", "about a diameter", inertia},
    {"squeal.rigid_disc.axial_inertia", number, "required", "about the axis", inertia},
    {"squeal.rigid_disc.stiffness",
     number,
     "required",
     "rotational spring",
     {.above = 0.0, .unit = "N m"}},
    {"squeal.rigid_disc.damping",
     number,
     "required",
     "of the rotational spring",
     {.at_least = 0.0, .unit = "N m s"}},
    {"squeal.rigid_disc.pad_radius", number, "required", "of the pads", length},
    {"squeal.rigid_disc.drive", word, "speed", "what turns the disc", {}, "speed | moment"},
    {"squeal.rigid_disc.equations", word, "nonlinear", "of transients", {}, "nonlinear | linear"},
    {"squeal.oscillator", table, "for the oscillator", "[oscillator](rigid_disc.md)"},
    {"squeal.oscillator.mass", number, "required", "of the body", mass},
    {"squeal.oscillator.stiffness_along", number, "required", "the surface", spring},
    {"squeal.oscillator.stiffness_normal", number, "required", "to the surface", spring},
    {"squeal.oscillator.stiffness_coupling",
     number,
     "required",
     "of both directions",
     {.at_least = 0.0, .unit = "N/m"}},
    {"squeal.oscillator.damping_along", number, "required", "along the surface", damper},
    {"squeal.oscillator.damping_normal", number, "required", "normal to it", damper},
    {"squeal.oscillator.contact_stiffness", number, "required", "of the contact", spring},
    {"squeal.oscillator.preload", number, "required", "of the contact", force},
    {"squeal.oscillator.radius", number, "required", "speed of the surface over rotation speed",
     length},
};

}  // namespace

std::span<const Key> brake_keys()
{
  return brake_rows;
}

}  // namespace chladni::scene
