#pragma once

#include "mbs_export/held_dofs.hpp"
#include "mbs_export/reduced_system.hpp"

/// Drilling rotations: rotations of attachment nodes about the normal of a shell, which elements
/// resist by a numerical stiffness alone.
namespace chladni::mbs_export {

/// True if this component of an attachment node is a drilling rotation or contains one.
bool is_drilling(const ReducedSystem& reduced, int node, int component);

/// Checks that a loaded component is no drilling rotation.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling_load(const ReducedSystem& reduced, int node, int component);

/// Checks that the body is held without the drilling rotations among the held DOFs.
/// @throws chladni::Error naming the node, the rotation and what to do.
void refuse_drilling_support(const ReducedSystem& reduced, const HeldDofs& held);

}  // namespace chladni::mbs_export
