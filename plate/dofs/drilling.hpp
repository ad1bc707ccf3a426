#pragma once

#include <span>

#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "plate/plate_options.hpp"

/// The drilling rotation of a shell, which is that about its normal. Elements resist it by a
/// stiffness without physical meaning that only keeps K from being singular, so no support, load or
/// inertia may act there.
namespace chladni::plate {

/// The unit normal of the shell at each node where only the drilling stiffness resists a rotation
/// about it. Zero where a beam begins, the shell has a fold, other nodes follow the node, its
/// motion is that of a coupling, or the nodes have no such component.
/// @return [n_nodes x 3], for the nodes of the DofMap
Eigen::MatrixX3d drilling_axes(const mesh::Mesh& mesh, const DofMap& dofs);
/// Those of some nodes alone, one row each.
Eigen::MatrixX3d drilling_axes(const mesh::Mesh& mesh, const DofMap& dofs,
                               std::span<const int> nodes);

/// Checks that no lumped mass has inertia and no spring or damper acts about a drilling axis.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, const Structure& structure);

/// Checks that no moment acts about a drilling axis.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const Load> loads);

/// Checks that the body is held without the drilling rotations that supports hold.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling(const mesh::Mesh& mesh, const DofMap& dofs, std::span<const Support> supports,
                     std::span<const Spring> springs);

}  // namespace chladni::plate
