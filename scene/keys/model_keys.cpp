#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible place{.unit = "m"};
constexpr Admissible second_moment{.above = 0.0, .unit = "m^4"};
constexpr Admissible shear_factor{.above = 0.0, .at_most = 1.0};
constexpr Admissible stiffness{.at_least = 0.0, .unit = "N/m, N m/rad"};
constexpr Admissible damping{.at_least = 0.0, .unit = "N s/m, N m s/rad"};
constexpr Admissible loss_factor{
    .at_least = 0.0, .usual_to = 2.0, .usually = "it is a pure number, 2 times a damping ratio"};
constexpr std::string_view components = "x | y | z | rx | ry | rz";

constexpr Key model_rows[] = {
    {"model", table, "six components", "[fewer DOFs at a node](beams.md)"},
    {"model.dofs", texts, "required", "components that every node has", {}, components},
    {"material", table, "required", "`[material.NAME]` for each material; isotropic, elastic"},
    {"material.*", table, "", "its name"},
    {"material.*.young",
     number,
     "required",
     "Young's modulus",
     {.above = 0.0,
      .unit = "Pa",
      .usual_from = 1e6,
      .usual_to = 1e13,
      .usually = "it is in Pa, and a steel has 2.1e11"}},
    {"material.*.poisson", number, "required", "Poisson's ratio", {.above = -1.0, .below = 0.5}},
    {"material.*.density",
     number,
     "required",
     "mass per volume",
     {.above = 0.0,
      .unit = "kg/m^3",
      .usual_from = 1.0,
      .usual_to = 3e4,
      .usually = "it is in kg/m^3, and a steel has 7850"}},
    {"material.*.loss_factor", number, "0", "[structural damping](damping.md)", loss_factor},
    {"section", tables, "required",
     "[sections](sections_and_couplings.md), one for each group of elements"},
    {"section.group", text, "required", "group of the mesh"},
    {"section.type", word, "required", "of the elements", {}, "shell | beam"},
    {"section.material", text, "required", "NAME of a material"},
    {"section.thickness",
     number,
     "required",
     "shell; or a table over a coordinate, or a formula of x, y, z, radius as text",
     {.above = 0.0, .unit = "m", .usual_to = 1.0, .usually = "it is in m; is it in mm?"}},
    {"section.thickness.over",
     word,
     "required",
     "what the table runs over",
     {},
     "x | y | z | radius"},
    {"section.thickness.at", numbers, "required", "ascending", place},
    {"section.thickness.values", numbers, "required", "as many", {.above = 0.0, .unit = "m"}},
    {"section.offset", number, "0",
     "shell: of the mid-surface from the mesh; or a table or formula as thickness", place},
    {"section.offset.over", word, "required", "what the table runs over", {}, "x | y | z | radius"},
    {"section.offset.at", numbers, "required", "ascending", place},
    {"section.offset.values", numbers, "required", "as many", place},
    {"section.loss_factor", number, "that of the material",
     "[structural damping](damping.md) of this section", loss_factor},
    {"section.theory", word, "timoshenko", "beam", {}, "timoshenko | bernoulli-euler"},
    {"section.area", number, "required", "beam", {.above = 0.0, .unit = "m^2"}},
    {"section.I_y", number, "required", "beam: int z^2 dA", second_moment},
    {"section.I_z", number, "required", "beam: int y^2 dA", second_moment},
    {"section.J", number, "required", "beam: torsion constant", second_moment},
    {"section.shear_factor_y", number, "5/6", "beam: kappa of kappa G A", shear_factor},
    {"section.shear_factor_z", number, "5/6", "beam", shear_factor},
    {"section.rotary_inertia", word, "full", "beam: of the bending rotations", {}, "full | none"},
    {"section.orientation", numbers, "needed unless y and z are alike",
     "beam: towards its z axis, [x, y, z]"},
    {"coupling", tables, "none", "[couplings](sections_and_couplings.md)"},
    {"coupling.type", word, "required", "how the group follows", {}, "rigid | averaging | link"},
    {"coupling.name", text, "required, but for a link", "of the reference node that it makes"},
    {"coupling.group", text, "required", "nodes that are coupled"},
    {"coupling.to", text, "required for a link", "group whose nearest nodes are followed"},
    {"mass", tables, "none", "[lumped masses](beams.md)"},
    {"mass.at", text, "required", "group or coupling"},
    {"mass.mass", number, "required", "at each node", {.above = 0.0, .unit = "kg"}},
    {"mass.inertia", numbers, "0", "[xx, yy, zz] or [xx, yy, zz, xy, xz, yz]", {.unit = "kg m^2"}},
    {"mass.offset", numbers, "[0, 0, 0]", "of the centre of mass from the node", place},
    {"spring", tables, "none", "[springs and dampers](beams.md)"},
    {"spring.at", text, "required", "group or coupling"},
    {"spring.to", text, "the ground", "group or coupling of one node"},
    {"spring.stiffness", table, "or `damping`", "by component, as `{ z = 1e6 }`"},
    {"spring.stiffness.*", number, "0", "x, y, z, rx, ry, rz", stiffness},
    {"spring.damping", table, "or `stiffness`", "by component"},
    {"spring.damping.*", number, "0", "x, y, z, rx, ry, rz", damping},
    {"spring.loss_factor", number, "0", "[structural damping](damping.md) of its stiffness",
     loss_factor},
    {"support", tables, "none", "of [`static` and `modes`](static_and_modes.md)"},
    {"support.group", text, "required", "group, ring or coupling"},
    {"support.type",
     word,
     "or `dofs`",
     "what is held",
     {},
     "clamped | simply-supported | symmetry"},
    {"support.dofs", texts, "or `type`", "components that are held", {}, components},
    {"support.normal", word, "required for symmetry", "of the plane", {}, "x | y | z"},
    {"load", tables, "none", "of `static`"},
    {"load.type", word, "required", "what acts", {}, "force | line | pressure | gravity"},
    {"load.group", text, "required, but for gravity", "group, ring or coupling"},
    {"load.force", numbers, "or `moment`", "of all nodes together, [x, y, z]", {.unit = "N"}},
    {"load.moment", numbers, "0", "of all nodes together, [x, y, z]", {.unit = "N m"}},
    {"load.line_force",
     numbers,
     "required for line",
     "on the edges of elements, [x, y, z]",
     {.unit = "N/m"}},
    {"load.pressure", number, "required for pressure", "along the normals", {.unit = "Pa"}},
    {"load.acceleration", numbers, "required for gravity", "[x, y, z]", {.unit = "m/s^2"}},
    {"static", table, "not asked for", "`chladni static`"},
    {"static.report", texts, "none", "groups whose displacements are listed"},
    {"modes", table, "not asked for", "`chladni modes`"},
    {"modes.count", integer, "10", "rigid-body motions included", {.at_least = 1}},
    {"modes.mesh_errors", truth, "false", "estimate what the mesh lets each frequency be off"},
};

}  // namespace

std::span<const Key> model_keys()
{
  return model_rows;
}

}  // namespace chladni::scene
