#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Key mesh_rows[] = {
    {"name", text, "disc", "stem of the files that the programs write; letters, digits, _ and -"},
    {"title", text, "the name", "for people"},
    {"accuracy", table, "as mesh and [reduce] are",
     "chooses the mesh, but of solids, and the reduction; "
     "[how](../how-to/meshes.md#a-mesh-for-an-accuracy)"},
    {"accuracy.error", number, "required",
     "of each natural frequency of the body under `body.fixed`, relative, of mesh and reduction "
     "together",
     from_to(1e-6, accuracy_error_max)},
    {"accuracy.up_to_Hz", number, "required", "of the frequencies that keep it", positive("Hz")},
    {"mesh", table,
     "required, except for models without a body and reduced systems of other programs",
     "[meshes](../how-to/meshes.md)"},
    {"mesh.generator", word, "or `file`", "what makes the mesh", no_number,
     "annulus | hat_disc | pad | rectangle | beam"},
    {"mesh.file", text, "or `generator`",
     ".msh, .geo, .step, .unv, .med, or a deck: .bdf, .nas, .dat, .inp, .cdb; beside the scene"},
    {"mesh.inner_radius", number, "required; hat_disc: wall_radius", "annulus, pad, hat_disc",
     positive("m")},
    {"mesh.outer_radius", number, "required", "annulus, pad, hat_disc; above the inner one",
     usually(positive("m"), 10.0, "it is in m; is it in mm?")},
    {"mesh.wall_radius", number, "required", "hat_disc: where the wall meets the ring",
     positive("m")},
    {"mesh.top_radius", number, "wall_radius", "hat_disc: where the wall meets the flange",
     positive("m")},
    {"mesh.hub_radius", number, "required", "hat_disc: inner edge of the flange", positive("m")},
    {"mesh.height", number, "required", "hat_disc: of the flange above the ring", positive("m")},
    {"mesh.foot", number, "0", "hat_disc: of the wall's lower edge above the ring",
     not_negative("m")},
    {"mesh.bolts", table, "none", "hat_disc: holes in the flange"},
    {"mesh.bolts.count", integer, "required", "number of holes", from_to(2, 1e4)},
    {"mesh.bolts.circle_radius", number, "required", "of their centres, on the flange",
     positive("m")},
    {"mesh.bolts.hole_radius", number, "required", "of each hole", positive("m")},
    {"mesh.extrude", table, "none: shells",
     "annulus, pad, rectangle: [solids](../how-to/solids.md) between two heights"},
    {"mesh.extrude.from", number, "required", "height of the lower face", in("m")},
    {"mesh.extrude.to", number, "required", "height of the upper face", in("m")},
    {"mesh.extrude.layers", integer, "1", "of elements", from_to(1, 1000)},
    {"mesh.angle_deg",
     number,
     "required",
     "pad: of the sector",
     {.above = 0.0, .below = 180.0, .unit = "degrees"}},
    {"mesh.centre_deg", number, "0", "pad: of the middle of the sector", in("degrees")},
    {"mesh.length", number, "required", "rectangle: along x", positive("m")},
    {"mesh.width", number, "required", "rectangle: along y", positive("m")},
    {"mesh.start", numbers, "required", "beam: [x, y, z]", in("m")},
    {"mesh.end", numbers, "required", "beam: [x, y, z]", in("m")},
    {"mesh.elements", integer, "or `element_size`", "beam: their number", from_to(1, 1e6)},
    {"mesh.points", tables, "none", "beam: nodes with a name"},
    {"mesh.points.name", text, "required", "of the node"},
    {"mesh.points.distance", number, "required", "from the start", not_negative("m")},
    {"mesh.element_size", number, "required without `accuracy`, and of solids; .step files too",
     "about that; at most the width of the body", positive("m")},
    {"mesh.element_order", integer, "3, of beam 1, chosen with `accuracy`; .geo and .step too",
     "of quadrilaterals, triangles and lines; shells of order 4 are quadrilaterals (a structured "
     "mesh)",
     from_to(1, 4)},
    {"mesh.pattern", word, "annulus: unstructured; others: structured", "of the elements",
     no_number, "structured | unstructured | triangles"},
    {"mesh.edge_row", number, "none, chosen with `accuracy`",
     "width of one row of elements along the edges", positive("m")},
    {"mesh.sectors", integer, "1; with `accuracy` what \"auto\" finds, where nothing is lost",
     "annulus, hat_disc, files: equal sectors about the z axis, of which one is meshed, 3 or more; "
     "1: the whole body; \"auto\": as many as the mesh of the whole body has; "
     "[sectors](../how-to/sectors.md)",
     from_to(1, 1e4)},
    {"mesh.rings", tables, "none", "circles with nodes exactly on them, or on faces of solids"},
    {"mesh.rings.name", text, "required", "by which the scene speaks of it"},
    {"mesh.rings.radius", number, "required", "about the z axis", positive("m")},
    {"mesh.rings.nodes", integer, "required", "at equal angles from the x axis", from_to(3, 1e5)},
    {"mesh.rings.z", number, "any", "of the circle, where several surfaces cross its cylinder",
     in("m")},
    {"mesh.rings.on", word, "nodes",
     "`face`: the ring has nodes of its own, which follow the plane face of any "
     "[solids](../how-to/solids.md#rings-on-any-mesh)",
     no_number, "nodes | face"},
    {"mesh.rings.width", number, "0: at points",
     "`face`: a node is the mean over a patch of the face so wide, and as long as the nodes are "
     "apart",
     positive("m")},
    {"mesh.parameters", table, "none", ".geo: numbers of its DefineConstant"},
    {"mesh.parameters.*", number, "", "any name that the .geo defines"},
    {"mesh.length_unit", word, "m; decks, .unv, .med: required",
     "of any file but a .step: what 1 in it is", no_number, "m | cm | mm | inch"},
    {"mesh.matrices", table, "none: sections",
     "files: [matrices of another program](../how-to/matrices.md) in place of sections"},
    {"mesh.matrices.stiffness", text, "required", "a file beside the scene"},
    {"mesh.matrices.mass", text, "required", "likewise"},
    {"mesh.matrices.damping", text, "none", "likewise, viscous"},
    {"mesh.matrices.structural_damping", text, "none", "likewise, H of K + i H"},
    {"mesh.matrices.dofs", text, "required where rows have numbers alone",
     "table of the node and component of each row, like 12.1"},
    {"mesh.force_unit", word, "N; lbf where lengths are inches",
     "of the matrices; masses are in what follows with seconds", no_number, "N | mN | kN | lbf"},
    {"mesh.groups", table, "none", "files: more groups"},
    {"mesh.groups.*", texts, "", "entities such as `surface_1`, or labels of a .step"},
    {"mesh.coincident_nodes", word, "refuse", "files: nodes of unconnected elements at one place",
     no_number, "refuse | merge | keep"},
    {"mesh.doubled_elements", word, "refuse", "decks: elements of one type with the same nodes",
     no_number, "refuse | merge | keep"},
    {"mesh.merge_tolerance", number, "1e-6 of the extent", "files: distance of nodes at one place",
     positive("m")},
};

}  // namespace

std::span<const Key> mesh_keys()
{
  return mesh_rows;
}

}  // namespace chladni::scene
