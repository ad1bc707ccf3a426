#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible frequency{.above = 0.0, .unit = "Hz"};
constexpr Admissible tolerance{.above = 0.0, .below = 1.0};
constexpr std::string_view components = "x | y | z | rx | ry | rz";

constexpr Key reduction_rows[] = {
    {"interface", table, "required for a reduction", "where loads, supports and pads may act"},
    {"interface.nodes", texts, "required",
     "rings, edges, points and couplings; all DOFs are masters"},
    {"interface.rings", tables, "all DOFs of each node",
     "of these rings a few harmonics are masters, not each node"},
    {"interface.rings.name", text, "required", "of a ring that stands in `interface.nodes`"},
    {"interface.rings.harmonics",
     integer,
     "required",
     "highest harmonic, cos and sin of six components each; half of the ring's nodes at most",
     {.at_least = 1}},
    {"interface.dofs", texts, "all six", "not available yet"},
    {"reduce", table, "required for a reduction", "[theory](theory.md)"},
    {"reduce.method",
     word,
     "auto with a tolerance, else required",
     "of the reduction: `auto` takes what costs least for a tolerance",
     {},
     "auto | craig-bampton | mixed-interface | guyan | rubin | macneal"},
    {"reduce.modes",
     integer,
     "or `cutoff_Hz`, `tolerance`",
     "modes of the method: with the masters held, with the nodes of `body.fixed` held, or free",
     {.above = 0.0}},
    {"reduce.cutoff_Hz", number, "or `modes`, `tolerance`", "those modes below it", frequency},
    {"reduce.tolerance", number, "or `modes`, `cutoff_Hz`",
     "relative error of the frequencies up to `up_to_Hz`", tolerance},
    {"reduce.up_to_Hz", number, "required for tolerance", "highest frequency of the tolerance",
     frequency},
    {"reduce.sylvester", truth, "true where it takes less than a tenth of the reduction",
     "count the eigenvalues of the FE model: is a mode missing? gives bounds of the errors"},
    {"reduce.pictures",
     word,
     "vertices",
     "nodes whose motion is kept for pictures",
     {},
     "vertices | all | none"},
    {"reduce.resultants", texts, "none", "groups whose section forces are kept"},
    {"reduce.resultant_elements",
     integers,
     "all of the groups",
     "element numbers of the mesh",
     {.above = 0.0}},
    {"reduce.mass_integrals", truth, "true", "keep what Coriolis and centrifugal forces need"},
    {"body", table, "free, all modes", "what `chladni body` makes of the reduced system"},
    {"body.fixed", texts, "[]", "interface nodes that are held: `hub`, or `hub.z` of them"},
    {"body.keep", table, "all modes", "modes of the held body to keep"},
    {"body.keep.modes", integer, "one of these", "the lowest", {.above = 0.0}},
    {"body.keep.up_to_Hz", number, "one of these", "those below; with tolerance its range",
     frequency},
    {"body.keep.list", integers, "one of these", "by number from 1, ascending", {.at_least = 1}},
    {"body.keep.tolerance", number, "one of these",
     "relative error of the frequency responses, against the FE model where the reduction tells "
     "its own",
     tolerance},
    {"body.interface_modes", tables, "none", "static or frequency-response modes"},
    {"body.interface_modes.kind",
     word,
     "required",
     "inertia relief or frequency response",
     {},
     "irm | frm"},
    {"body.interface_modes.at", text, "required", "interface node"},
    {"body.interface_modes.dofs", texts, "required", "loaded components", {}, components},
    {"body.interface_modes.omega0",
     number,
     "auto",
     "frm: frequency of the loads, or \"auto\"",
     {.above = 0.0, .unit = "rad/s"}},
    {"body.interface_modes.space",
     word,
     "reduced",
     "frm: computed in the reduced or in the FE model",
     {},
     "reduced | full"},
    {"body.damping", table, "none; matrix with dampers", "of the modal body"},
    {"body.damping.type",
     word,
     "required",
     "how it is given",
     {},
     "none | modal | rayleigh | matrix"},
    {"body.damping.ratio",
     number,
     "required for modal",
     "of critical; one, or a list of one for each mode",
     {.at_least = 0.0, .below = 1.0}},
    {"body.damping.alpha",
     number,
     "required for rayleigh",
     "C = alpha M + beta K",
     {.at_least = 0.0, .unit = "1/s"}},
    {"body.damping.beta",
     number,
     "required for rayleigh",
     "C = alpha M + beta K",
     {.at_least = 0.0, .unit = "s"}},
};

}  // namespace

std::span<const Key> reduction_keys()
{
  return reduction_rows;
}

}  // namespace chladni::scene
