#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Pairs of nodes nearer than `tolerance` [m], by index. Each pair holds a node and the first node
/// of its cluster.
std::vector<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double tolerance);

/// Treats nodes of unconnected elements that stand at one place, within `merge_tolerance`. Without
/// a tolerance it is a millionth of the extent of the mesh, at most a tenth of the smallest
/// distance in an element. Nodes that are both in `coupled_groups` or in equations are joined
/// already. Merged nodes keep the lower number; a note in Mesh::notes gives how many were merged.
/// @throws chladni::Error with the numbers of the first pairs when the treatment is to refuse them,
///         and with the number of an element that the tolerance would make collapse.
Mesh treat_coincident_nodes(Mesh mesh, const MeshOptions& options);

/// Adds the missing inner nodes of serendipity elements (8-node quadrilaterals and the like), whose
/// lattice holds -1 in their places. Their positions follow from the element's own shape functions:
/// on a quadrilateral by transfinite interpolation of the edges, which is the serendipity space up
/// to order 3, on a cubic triangle at its centre. New nodes get numbers beyond the largest, join
/// the surface groups of their elements, and are mentioned in Mesh::notes.
/// @throws chladni::Error for a triangle of order 4 without inner nodes.
void add_inner_nodes(Mesh& mesh);

/// Replaces each quadrilateral with a corner of more than 165 degrees, where its Jacobian (nearly)
/// vanishes, by the two triangles that halve this corner. Recombination leaves such elements where
/// two edges of one triangle lie on a smooth boundary. No node is added, since the lattice of a
/// quadrilateral contains those of both triangles. The triangles keep the number of the
/// quadrilateral.
Mesh split_flat_corners(Mesh mesh);

/// The elements of a block that have the same nodes as one before them: the first one and the
/// other, ascending by the other.
std::vector<std::array<int, 2>> doubled_elements(const ElementBlock& block);

/// Makes elements of one type with the same nodes one element, since some formats write an element
/// once for each of its groups. It is of the group that has a section (`shell_groups`,
/// `line_groups`), else of that of the first one. A note tells how many there were.
/// @throws chladni::Error naming two groups of an element that have a section each.
void merge_doubled_elements(Mesh& mesh, const MeshOptions& options);

}  // namespace chladni::mesh
