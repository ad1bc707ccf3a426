#pragma once

#include "mbs_export/held_dofs.hpp"
#include "mbs_export/reduced_system.hpp"

/// Rotations of attachment nodes about the normal of a shell, which elements resist by a numerical
/// stiffness alone.
namespace chladni::mbs_export {

/// Whether this component of an attachment node is, or has a share of, such a rotation.
bool is_drilling(const ReducedSystem& reduced, int node, int component);

/// @throws chladni::Error naming the node, the rotation and what to do where it is one.
void refuse_drilling_load(const ReducedSystem& reduced, int node, int component);

/// Such rotations may be held as long as the body is held without them.
/// @throws chladni::Error likewise when they are all that holds a rigid-body motion.
void refuse_drilling_support(const ReducedSystem& reduced, const HeldDofs& held);

}  // namespace chladni::mbs_export
