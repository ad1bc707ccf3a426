#pragma once

#include "mesh/mesh.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// Nodes of one element in its order, [n x 3], m.
NodeVectors element_positions(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

/// Mean unit normal at every node over the surface elements that meet there, [n_nodes x 3]; zero
/// where there are none. Elements of opposite orientation count with their normals turned.
/// @throws chladni::Error naming an element and node where the Jacobian is not positive.
NodeVectors mean_normals(const mesh::Mesh& mesh);

/// The mean normals where they are the directors of all elements that meet at the node; zero at
/// kinks, and where there are no surface elements.
NodeVectors smooth_normals(const mesh::Mesh& mesh);

/// Mid-surface points, off the mesh by the section's offset, and half-thickness directors of one
/// element. A director is the mean normal
/// where the surface is smooth, and the element's own normal at a kink of more than 20 degrees; it
/// points to the side to which the element is oriented.
ShellNodes shell_nodes(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const NodeVectors& normals, const ShellSection& section);

}  // namespace chladni::plate
