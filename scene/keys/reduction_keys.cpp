#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible tolerance{.above = 0.0, .below = 1.0};
constexpr std::string_view loaded_components = "x | y | z | rx | ry | rz";

constexpr Key reduction_rows[] = {
    {"interface", table, "required for a reduction", "where loads, supports and pads may act"},
    {"interface.nodes", texts, "required",
     "rings, edges, points and couplings; all DOFs are masters"},
    {"interface.rings", tables, "all DOFs of each node",
     "of these rings a few harmonics are masters, not each node"},
    {"interface.rings.name", text, "required", "of a ring that stands in `interface.nodes`"},
    {"interface.rings.harmonics", integer, "required",
     "highest harmonic, cos and sin of six components each; half of the ring's nodes at most",
     at_least(1)},
    {"reduce", table, "required for a reduction without `accuracy`",
     "[theory](../explanation/theory.md)"},
    {"reduce.method", word, "auto with a tolerance, else required",
     "of the reduction: `auto` takes what costs least for a tolerance", no_number,
     "auto | craig-bampton | mixed-interface | guyan | rubin"},
    {"reduce.modes", integer, "or `cutoff_Hz`, `tolerance`",
     "modes of the method: with the masters held, with the nodes of `body.fixed` held, or free",
     positive()},
    {"reduce.cutoff_Hz", number, "or `modes`, `tolerance`", "those modes below it", positive("Hz")},
    {"reduce.tolerance", number, "or `modes`, `cutoff_Hz`",
     "relative error of the frequencies up to `up_to_Hz`", tolerance},
    {"reduce.up_to_Hz", number, "required for tolerance", "highest frequency of the tolerance",
     positive("Hz")},
    {"reduce.sylvester", truth, "true where it takes less than a tenth of the reduction",
     "count the eigenvalues of the FE model: is a mode missing? gives bounds of the errors"},
    {"reduce.ranks_per_harmonic", integer, "as many as there are for each",
     "of [sectors](../how-to/sectors.md): MPI ranks that share one harmonic, of which less memory "
     "each has",
     at_least(1)},
    {"reduce.mesh_errors", truth, "true with `accuracy`, else false",
     "estimate what the mesh lets each frequency of the body be off"},
    {"reduce.pictures", word, "vertices", "nodes whose motion is kept for pictures", no_number,
     "vertices | all | none"},
    {"reduce.resultants", texts, "none",
     "groups whose section forces, of solids stresses, are kept"},
    {"reduce.resultant_elements", integers, "all of the groups", "element numbers of the mesh",
     positive()},
    {"reduce.mass_integrals", truth, "true", "keep what Coriolis and centrifugal forces need"},
    {"reduce.stiffening", texts, "none",
     "motions of the frame whose stress stiffens the [body](../explanation/theory.md) held as "
     "`body.fixed` says; "
     "for other programs: `[squeal]` does not use it",
     no_number, "spin-x | spin-y | spin-z | spin | angular-acceleration | acceleration"},
    {"body", table, "free, all modes", "what `chladni body` makes of the reduced system"},
    {"body.fixed", texts, "[]", "interface nodes that are held: `hub`, or `hub.z` of them"},
    {"body.keep", table, "all modes; with `accuracy` by its tolerance",
     "modes of the held body to keep"},
    {"body.keep.modes", integer, "one of these", "the lowest", positive()},
    {"body.keep.up_to_Hz", number, "one of these", "those below; with tolerance its range",
     positive("Hz")},
    {"body.keep.list", integers, "one of these", "by number from 1, ascending", at_least(1)},
    {"body.keep.tolerance", number, "one of these",
     "relative error of the frequency responses, against the FE model if the reduction knows its "
     "own",
     tolerance},
    {"body.interface_modes", tables, "none", "static or frequency-response modes"},
    {"body.interface_modes.kind", word, "required", "inertia relief or frequency response",
     no_number, "irm | frm"},
    {"body.interface_modes.at", text, "required", "interface node"},
    {"body.interface_modes.dofs", texts, "required", "loaded components", no_number,
     loaded_components},
    {"body.interface_modes.omega0", number, "auto", "frm: frequency of the loads, or \"auto\"",
     positive("rad/s")},
    {"body.interface_modes.space", word, "reduced",
     "frm: computed in the reduced or in the FE model", no_number, "reduced | full"},
    {"body.damping", table, "none; matrix with dampers or loss factors", "of the modal body"},
    {"body.damping.type", word, "required", "how it is given", no_number,
     "none | modal | rayleigh | matrix"},
    {"body.damping.ratio",
     number,
     "required for modal",
     "of critical; one, a list of one for each mode, or a [table](../how-to/damping.md) over the "
     "frequency",
     {.at_least = 0.0, .below = 1.0}},
    {"body.damping.ratio.at_Hz", numbers, "required",
     "ascending; all modes of the body lie between the first and the last", not_negative("Hz")},
    {"body.damping.ratio.values", numbers, "required", "as many", {.at_least = 0.0, .below = 1.0}},
    {"body.damping.alpha", number, "required for rayleigh", "C = alpha M + beta K",
     not_negative("1/s")},
    {"body.damping.beta", number, "required for rayleigh", "C = alpha M + beta K",
     not_negative("s")},
};

}  // namespace

std::span<const Key> reduction_keys()
{
  return reduction_rows;
}

}  // namespace chladni::scene
