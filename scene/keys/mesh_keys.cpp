#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible length{.above = 0.0, .unit = "m"};
constexpr Admissible place{.unit = "m"};

constexpr Key mesh_rows[] = {
    {"name", text, "disc", "stem of the files that the programs write; letters, digits, _ and -"},
    {"title", text, "the name", "for people"},
    {"mesh", table, "required, but for models without a body", "[meshes](meshes.md)"},
    {"mesh.generator",
     word,
     "or `file`",
     "what makes the mesh",
     {},
     "annulus | hat_disc | pad | rectangle | beam"},
    {"mesh.file", text, "or `generator`", ".msh, .geo or .step beside the scene"},
    {"mesh.inner_radius", number, "required; hat_disc: wall_radius", "annulus, pad, hat_disc",
     length},
    {"mesh.outer_radius", number, "required", "annulus, pad, hat_disc; above the inner one",
     length},
    {"mesh.wall_radius", number, "required", "hat_disc: where the wall meets the ring", length},
    {"mesh.top_radius", number, "wall_radius", "hat_disc: where the wall meets the flange", length},
    {"mesh.hub_radius", number, "required", "hat_disc: inner edge of the flange", length},
    {"mesh.height", number, "required", "hat_disc: of the flange above the ring", length},
    {"mesh.foot",
     number,
     "0",
     "hat_disc: of the wall's lower edge above the ring",
     {.at_least = 0.0, .unit = "m"}},
    {"mesh.bolts", table, "none", "hat_disc: holes in the flange"},
    {"mesh.bolts.count", integer, "required", "number of holes", {.at_least = 2, .at_most = 1e4}},
    {"mesh.bolts.circle_radius", number, "required", "of their centres, on the flange", length},
    {"mesh.bolts.hole_radius", number, "required", "of each hole", length},
    {"mesh.angle_deg",
     number,
     "required",
     "pad: of the sector",
     {.above = 0.0, .below = 180.0, .unit = "degrees"}},
    {"mesh.centre_deg", number, "0", "pad: of the middle of the sector", {.unit = "degrees"}},
    {"mesh.length", number, "required", "rectangle: along x", length},
    {"mesh.width", number, "required", "rectangle: along y", length},
    {"mesh.start", numbers, "required", "beam: [x, y, z]", place},
    {"mesh.end", numbers, "required", "beam: [x, y, z]", place},
    {"mesh.elements",
     integer,
     "or `element_size`",
     "beam: their number",
     {.at_least = 1, .at_most = 1e6}},
    {"mesh.points", tables, "none", "beam: nodes with a name"},
    {"mesh.points.name", text, "required", "of the node"},
    {"mesh.points.distance", number, "required", "from the start", {.at_least = 0.0, .unit = "m"}},
    {"mesh.element_size", number, "required; .step files too",
     "about that; at most the width of the body", length},
    {"mesh.element_order",
     integer,
     "3; .geo and .step too",
     "of quadrilaterals and triangles",
     {.at_least = 1, .at_most = 4}},
    {"mesh.pattern",
     word,
     "annulus: unstructured; others: structured",
     "of the elements",
     {},
     "structured | unstructured | triangles"},
    {"mesh.edge_row", number, "none", "width of one row of elements along the edges", length},
    {"mesh.rings", tables, "none", "circles with nodes exactly on them"},
    {"mesh.rings.name", text, "required", "by which the scene speaks of it"},
    {"mesh.rings.radius", number, "required", "about the z axis", length},
    {"mesh.rings.nodes",
     integer,
     "required",
     "at equal angles from the x axis",
     {.at_least = 3, .at_most = 1e5}},
    {"mesh.rings.z", number, "any", "of the circle, where several surfaces cross its cylinder",
     place},
    {"mesh.parameters", table, "none", ".geo: numbers of its DefineConstant"},
    {"mesh.parameters.*", number, "", "any name that the .geo defines"},
    {"mesh.length_unit",
     word,
     "m",
     ".msh and .geo: what 1 in the file is",
     {},
     "m | cm | mm | inch"},
    {"mesh.groups", table, "none", "files: more groups"},
    {"mesh.groups.*", texts, "", "entities such as `surface_1`, or labels of a .step"},
    {"mesh.coincident_nodes",
     word,
     "refuse",
     "files: nodes of unconnected elements at one place",
     {},
     "refuse | merge | keep"},
    {"mesh.merge_tolerance", number, "1e-6 of the extent", "files: distance of nodes at one place",
     length},
};

}  // namespace

std::span<const Key> mesh_keys()
{
  return mesh_rows;
}

}  // namespace chladni::scene
