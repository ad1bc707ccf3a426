#pragma once

#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"

namespace chladni::cases {

/// The attachment nodes of a scene in the FE system, and the masters: all DOFs of these nodes, but
/// of rings that have harmonics as DOFs the wanted ones of these, after all others.
struct Attachments {
  std::vector<int> nodes;  ///< indices into DofMap::positions, each once, in the scene's order
  std::vector<mbs_export::AttachmentSet> sets;
  std::vector<mbs_export::MasterDof> masters;  ///< nodes as places in `nodes`
  std::vector<int> master_dofs;                ///< [n_m] of K
  std::vector<Eigen::Vector3d> drilling_axes;  ///< of the nodes, as in mbs_export::AttachmentNode
};

/// @param names  groups or rings of the mesh, or reference nodes of couplings; rings of harmonics
///               among them.
/// @throws chladni::Error for an unknown name, naming those that exist, and for an attachment node
///         that depends on a coupling.
Attachments find_attachments(const mesh::Mesh& mesh, const plate::DofMap& dofs,
                             const std::vector<std::string>& names);

/// Whether some node of the set has its motion by the harmonics of a ring.
bool has_ring_nodes(const Attachments& attachments, const plate::DofMap& dofs,
                    const mbs_export::AttachmentSet& set);

/// F: the motion of the attachment nodes that each master is the amplitude of.
/// @return [6 n_nodes x n_m]
Eigen::MatrixXd master_shapes(const Attachments& attachments, const plate::DofMap& dofs);

/// Number of a node in the files: that of the mesh, or one behind them for a reference node.
std::int64_t node_number(const mesh::Mesh& mesh, const plate::DofMap& dofs, int node);

}  // namespace chladni::cases
