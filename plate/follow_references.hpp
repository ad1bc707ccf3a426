#pragma once

#include <span>

#include "plate/dof_map.hpp"

namespace chladni::plate {

/// Adds the reference nodes of the couplings to the map, and for each dependent node the reference
/// at the end of its chain. The map has the nodes of the mesh, and no numbers yet.
/// @throws chladni::Error as make_dof_map, but for averages.
void follow_references(const mesh::Mesh& mesh, std::span<const Coupling> couplings, DofMap& map);

/// `coupling "hub"` or `link of "wall_foot" to "wall_seat"`, for messages.
std::string describe(const Coupling& coupling);

}  // namespace chladni::plate
