#pragma once

#include <unordered_map>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// The positions of the nodes of an element in its order, [n x 3], m.
NodeVectors element_positions(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

/// For each node of a mesh whether something is wanted of it.
using NodeMask = std::vector<char>;

/// The unit directors of the surface elements at their nodes.
///
/// The elements at a node form sheets. Two that share an edge there are of one sheet where the edge
/// folds by 40 degrees at most; of three and more that share it, as in a T joint, two are where the
/// edge folds half as much between them as between either and any other. The director of a sheet is
/// the mean of its elements' normals, weighted by their angles at the node, but an element whose
/// own normal is more than 20 degrees off has that.
struct Directors {
  /// [n_nodes x 3] Of nodes with one director for all elements, either way round; zero elsewhere.
  NodeVectors common;
  /// Of other nodes: [n_blocks] from nodes_per_element * element + place in the element, to the
  /// side to which it is oriented.
  std::vector<std::unordered_map<std::size_t, Eigen::RowVector3d>> own;
};

/// The directors of a mesh. The elements at the cut edges of a sector have neighbours in the next.
/// @param wanted  nodes at which they are computed, those of the others being zero; empty: all
/// @throws chladni::Error naming an element and node where the Jacobian is not positive; of the
///         elements with a node that is wanted.
Directors shell_directors(const mesh::Mesh& mesh, NodeMask wanted = {});

/// Mid-surface points of one element, at the section's offset from the mesh, and its half-thickness
/// directors, to the side to which the element is oriented. Thickness and offset are lengths along
/// the directors. Where faces would cross in an element smaller than the thickness, its directors
/// are its own normals.
ShellNodes shell_nodes(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element,
                       const Directors& directors, const ShellSection& section);

}  // namespace chladni::plate
