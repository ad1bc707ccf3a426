#include "scene/keys.hpp"

namespace chladni::scene {
namespace {

using enum KeyKind;

constexpr Admissible part_place = usually(in("m"), 10.0, "it is in m; is it in mm?");
constexpr Admissible part_length = usually(not_negative("m"), 1.0, "it is in m; is it in mm?");
constexpr Admissible lining_friction =
    usually(not_negative(), 2.0, "it is a pure number, of linings 0.2 to 0.7");

constexpr Key assembly_rows[] = {
    {"part", tables, "required for an assembly",
     "a modal body of the brake; [assembly](../how-to/several_bodies.md)"},
    {"part.name", text, "required", "by which joints and contacts name it"},
    {"part.body", text, "required", "its file, as seen from the folder of --output"},
    {"part.position", numbers, "[0, 0, 0]", "of the origin of its mesh in the brake", part_place},
    {"part.rotation_deg", numbers, "[0, 0, 0]",
     "about x, then y, then z of the brake, before it is moved", in("degrees")},
    {"joint", tables, "none", "joins nodes of two parts, or of a part and the ground"},
    {"joint.between", texts, "required",
     "two of \"PART.SET\" and \"ground\"; sets of several nodes are joined node by node"},
    {"joint.type", word, "required", "springs and dampers, or the same motion", no_number,
     "spring | rigid"},
    {"joint.dofs", texts, "all six",
     "components that a rigid joint joins; without them the rotation about the normal of a smooth "
     "shell stays free"},
    {"joint.stiffness", table, "required for springs", "along and about the axes of the brake"},
    {"joint.stiffness.*", number, "0",
     "of each pair of nodes; `x`, `y`, `z` N/m, `rx`, `ry`, `rz` N m", not_negative()},
    {"joint.damping", table, "none", "along and about the axes of the brake"},
    {"joint.damping.*", number, "0",
     "of each pair of nodes; `x`, `y`, `z` N s/m, `rx`, `ry`, `rz` N m s", not_negative()},
    {"joint.span", number, "nodes in one place",
     "distance of two nodes that the joint may bridge rigidly", not_negative("m")},
    {"contact", tables, "required for an assembly", "a lining between a part and the disc"},
    {"contact.face", text, "required", "\"PART.SET\", the nodes of the face"},
    {"contact.height", number, "required",
     "of these nodes above the contact plane: half of the plate and the lining; 0 of a solid",
     part_length},
    {"contact.stiffness", number, "or stiffness_per_area", "of the whole lining", positive("N/m")},
    {"contact.stiffness_per_area", number, "or stiffness",
     "of the lining: Young's modulus under plane strain over its thickness", positive("N/m^3")},
    {"contact.damping", number, "0", "of the whole lining", not_negative("N s/m")},
    {"contact.damping_per_area", number, "0", "of the lining", not_negative("N s/m^3")},
    {"contact.preload", number, "or pressure", "of the whole lining", positive("N")},
    {"contact.pressure", number, "or preload", "of the lining", positive("Pa")},
    {"contact.shares", word, "by area", "of the nodes in stiffness, damping and preload", no_number,
     "by area | equal"},
    {"contact.friction", number, "squeal.friction", "of this lining; or a table as there",
     lining_friction},
    {"contact.friction.kinetic", number, "required", "of fast sliding", lining_friction},
    {"contact.friction.static", number, "kinetic", "as there", not_negative()},
    {"contact.friction.decay_speed", number, "required with static", "as there", positive("m/s")},
    {"contact.friction.regularisation", number, "0", "as there", positive("m/s")},
    {"contact.friction.table", tables, "or kinetic", "as there"},
    {"contact.friction.table.temperature_C", number, "none", "as there"},
    {"contact.friction.table.pressure_Pa", number, "none", "as there", not_negative()},
    {"contact.friction.table.speed_m_s", numbers, "any speed", "as there", not_negative()},
    {"contact.friction.table.mu", numbers, "required", "as there", lining_friction},
    {"contact.friction.temperature_C", number, "required with temperatures", "as there"},
    {"contact.friction.factor", number, "1", "as there", not_negative()},
    {"squeal.disc", text, "required for an assembly", "the part that turns, about the z axis"},
    {"squeal.rings", texts, "required for an assembly",
     "rings of the disc, whose radii enclose those of all faces"},
    {"squeal.convection", word, "kept",
     "terms of a disc that moves under the pads as it turns; without them friction slides over a "
     "disc "
     "that stands still",
     no_number, "kept | left out"},
};

}  // namespace

std::span<const Key> assembly_keys()
{
  return assembly_rows;
}

}  // namespace chladni::scene
