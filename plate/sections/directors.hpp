#pragma once

#include "mesh/mesh.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The positions of the nodes of an element in its order, [n x 3], m.
NodeVectors element_positions(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

/// The mean unit normal at every node over the surface elements that meet there, [n_nodes x 3];
/// zero where there are none. Normals of elements with opposite orientation are reversed.
/// @throws chladni::Error naming an element and node where the Jacobian is not positive.
NodeVectors mean_normals(const mesh::Mesh& mesh);

/// The mean normals of nodes at which they are the directors of all elements, [n_nodes x 3]; zero
/// at kinks, and where there are no surface elements.
NodeVectors smooth_normals(const mesh::Mesh& mesh);

/// Mid-surface points of one element, at the section's offset from the mesh, and its half-thickness
/// directors. A director is the mean normal where the surface is smooth, and the element's own
/// normal at a kink of more than 20 degrees. It points to the side to which the element is
/// oriented.
ShellNodes shell_nodes(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const NodeVectors& normals, const ShellSection& section);

}  // namespace chladni::plate
