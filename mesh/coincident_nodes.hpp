#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Pairs of nodes nearer than `tolerance` [m], by index. Each pair holds a node and the first node
/// of its cluster.
std::vector<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double tolerance);

/// Treats nodes of unconnected elements that stand at one place, within `merge_tolerance`. Without
/// a tolerance it is a millionth of the extent of the mesh, at most a tenth of the smallest
/// distance in an element. Nodes that are both in `coupled_groups` are joined already. Merged nodes
/// keep the lower number; a note in Mesh::notes gives how many were merged.
/// @throws chladni::Error with the numbers of the first pairs when the treatment is to refuse them,
///         and with the number of an element that the tolerance would make collapse.
Mesh treat_coincident_nodes(Mesh mesh, const MeshOptions& options);

}  // namespace chladni::mesh
