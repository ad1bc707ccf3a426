#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Masters whose displacement is prescribed to be zero.
struct HeldDofs {
  std::vector<int> rows;           ///< of K_r, ascending, each once
  std::vector<std::string> names;  ///< "hub.rx", or "track.z (node 17)" in a set of several nodes
};

/// The masters of "SET" (all components) or "SET.x|y|z|rx|ry|rz" in each entry of `fixed`.
/// @throws chladni::Error naming what exists, for an unknown set or component, or a component
///         that is no master.
HeldDofs held_dofs(const ReducedSystem& reduced, const std::vector<std::string>& fixed);

/// The row of K_r of one component of an attachment node.
/// @throws chladni::Error when it is no master.
int master_row(const ReducedSystem& reduced, int node, int component);

/// "x", "y", "z", "rx", "ry", "rz" of component 0..5.
const char* component_name(int component);

}  // namespace chladni::mbs_export
