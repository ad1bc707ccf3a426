#pragma once

#include <span>

#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/load_options.hpp"
#include "plate/plate_options.hpp"

/// The drilling rotation of a shell, that about its normal: elements resist it by a stiffness
/// without physical meaning, which only keeps K from being singular. Nothing may be supported,
/// loaded or given inertia there.
namespace chladni::plate {

/// For each node the unit normal of the shell, where nothing but the drilling stiffness resists a
/// rotation about it; zero where a beam begins, the shell is folded, other nodes follow the node,
/// its motion is that of a coupling, or the nodes have no such component.
/// @return [n_nodes x 3], of the nodes of the DofMap
Eigen::MatrixX3d drilling_axes(const mesh::Mesh& mesh, const DofMap& dofs);

/// @throws chladni::Error naming the node, the rotation and what to do when a lumped mass has
///         inertia, or a spring or damper acts, about a drilling axis.
void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, const Structure& structure);

/// @throws chladni::Error likewise when a moment acts about a drilling axis.
void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const Load> loads);

/// Supports may hold drilling rotations as long as the body is held without them.
/// @throws chladni::Error likewise when they are all that holds a rigid-body motion.
void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const Support> supports,
                     std::span<const Spring> springs);

}  // namespace chladni::plate
