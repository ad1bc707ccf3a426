#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/load_options.hpp"

namespace chladni::plate {

/// The DOFs that the supports hold at zero, ascending, each once; the same on every rank.
/// @throws chladni::Error for an unknown group, a group without nodes, and a node whose motion
///         follows a coupling, naming what to support instead.
std::vector<int> held_dofs(const mesh::Mesh& mesh, const DofMap& dofs,
                           std::span<const Support> supports);

}  // namespace chladni::plate
