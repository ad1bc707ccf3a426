#pragma once

#include "mesh/mesh.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The positions of the nodes of an element in its order, [n x 3], m.
NodeVectors element_positions(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

/// For each node of a mesh whether something is wanted of it.
using NodeMask = std::vector<char>;

/// The mean unit normal at every node over the surface elements that meet there, [n_nodes x 3];
/// zero where there are none. Normals of elements with opposite orientation are reversed.
/// @param wanted  nodes whose normals are computed, those of the others being zero; empty: all
/// @throws chladni::Error naming an element and node where the Jacobian is not positive; of the
///         elements with a node that is wanted.
NodeVectors mean_normals(const mesh::Mesh& mesh, NodeMask wanted = {});

/// The mean normals of nodes at which they are the directors of all elements, [n_nodes x 3]; zero
/// at kinks, and where there are no surface elements.
/// @param wanted  as of `mean_normals`
/// @throws chladni::Error as `mean_normals`.
NodeVectors smooth_normals(const mesh::Mesh& mesh, NodeMask wanted = {});

/// Mid-surface points of one element, at the section's offset from the mesh, and its half-thickness
/// directors. A director is the mean normal where the surface is smooth, and the element's own
/// normal at a kink of more than 20 degrees. It points to the side to which the element is
/// oriented.
ShellNodes shell_nodes(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const NodeVectors& normals, const ShellSection& section);

}  // namespace chladni::plate
