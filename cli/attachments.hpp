#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/dof_map.hpp"

namespace chladni::cli {

/// The attachment nodes of a scene in the FE system.
struct Attachments {
  std::vector<int> nodes;  ///< indices into DofMap::positions, each once, in the scene's order
  std::vector<mbs_export::AttachmentSet> sets;
};

/// @param names  groups or rings of the mesh, or reference nodes of couplings.
/// @throws chladni::Error for an unknown name, naming those that exist, and for an attachment node
///         that depends on a coupling.
Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names);

/// Number of a node in the files: that of the mesh, or one behind them for a reference node.
std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node);

}  // namespace chladni::cli
