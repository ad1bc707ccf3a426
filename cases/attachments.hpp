#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"

namespace chladni::cases {

/// The attachment nodes of a scene in the FE system, and the masters. Masters are all DOFs of these
/// nodes; of a ring that has harmonics as DOFs they are the wanted harmonics, after all others.
struct Attachments {
  std::vector<int> nodes;  ///< indices into DofMap::positions, each once, in the scene's order
  std::vector<mbs_export::AttachmentSet> sets;
  /// Their `node` is a place in `nodes`.
  std::vector<mbs_export::MasterDof> masters;
  std::vector<int> master_dofs;                ///< [n_m] of K
  std::vector<Eigen::Vector3d> drilling_axes;  ///< of the nodes, as in mbs_export::AttachmentNode
};

/// Finds the attachment nodes and masters.
/// @param names  groups or rings of the mesh, rings of harmonics, or reference nodes of couplings
/// @throws chladni::Error for an unknown name, naming those that exist, and for an attachment node
///         that depends on a coupling.
Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names);

/// True if a node of the set moves by the harmonics of a ring.
bool has_ring_nodes(const Attachments& attachments, const plate::DofMap& dofs,
                    const mbs_export::AttachmentSet& set);

/// F: the motion of the attachment nodes by a unit amplitude of each master.
/// @return [6 n_nodes x n_m]
Eigen::MatrixXd master_shapes(const Attachments& attachments, const plate::DofMap& dofs);

/// The number of a node in files: that of the mesh, or a number after them for a reference node.
std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node);

}  // namespace chladni::cases
