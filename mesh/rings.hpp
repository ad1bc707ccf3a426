#pragma once

#include <span>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Adds a group for each ring: its nodes at equal angles on a circle about the z axis, the first on
/// the x axis, ordered by angle. Nodes that miss their place by less than a thousandth of the
/// distance between two neighbours are moved there, with a note. In a sector the group has the
/// nodes of the sector, including those of both cut edges.
/// @throws chladni::Error with the angle when no node of the mesh stands at a place, or when
///         several do, one above the other, and the ring has no z.
void add_rings(Mesh& mesh, std::span<const RingOptions> rings);

}  // namespace chladni::mesh
