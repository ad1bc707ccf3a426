#pragma once

#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/beam_element.hpp"
#include "plate/elements/shell_element.hpp"
#include "plate/elements/shell_strains.hpp"
#include "plate/elements/solid_element.hpp"
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

/// The section of each group of the mesh as an index into Structure; -1 for none.
struct SectionMap {
  std::vector<int> shell;        ///< [n_groups]
  std::vector<int> beam;         ///< [n_groups]
  std::vector<int> solid;        ///< [n_groups]
  std::vector<char> on_surface;  ///< [n_nodes] true for the nodes of surface elements
};

/// [n_nodes] True for the nodes of surface elements.
std::vector<char> nodes_on_surfaces(const mesh::Mesh& mesh);

/// The fields of a line: where it shares its inner nodes with surfaces, theirs, which makes a rib
/// converge as they do.
LineFields line_fields(const std::vector<char>& on_surface, std::span<const int> nodes);

/// Finds the section of each group. It checks the whole mesh, so that either all ranks throw or
/// none.
/// @throws chladni::Error when an element has no section, a section has no elements, an element of
///         this shape and order does not exist, or the axes of a beam are not defined.
SectionMap map_sections(const mesh::Mesh& mesh, const Structure& structure);

/// The data on which the matrices of an element depend besides its nodes.
struct ElementContext {
  const SectionMap& sections;
  const Structure& structure;
  const Directors& directors;
};

/// K_e and M_e of an element, and the places of its DOFs.
struct PlacedMatrices {
  ElementMatrices matrices;
  NodeVectors arms;  ///< [n x 3] m, from the nodes of the mesh to the DOFs; empty for zero
};

/// The matrices of an element of the mesh. The DOFs of a shell are on its mid-surface, at the
/// section's offset from the mesh.
PlacedMatrices element_matrices(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                int element, const ElementContext& context);

/// The loss factor eta of an element: that of its section if set, else that of the material.
double loss_factor(const mesh::ElementBlock& block, int element, const ElementContext& context);

/// True if a section, a material or a spring has a loss factor above zero.
bool has_loss_factors(const Structure& structure);

/// The index into `sections` of each group of the mesh; -1 where there is none.
/// @throws chladni::Error when the group of a section is unknown or has no elements of its kind.
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const ShellSection> sections);
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const BeamSection> sections);
std::vector<int> section_of_group(const mesh::Mesh& mesh, std::span<const SolidSection> sections);

/// What shells hold twice where one ends on the mid-surface of another that goes on, in kg.
struct RibOverlap {
  double twice;  ///< between that mid-surface and the face to which it ends
  double mass;   ///< of all shells
};

/// The overlap at the edges that three or more surface elements share; two of them that go on over
/// the edge are the plate, the others are ribs. Edges on the cuts of a sector are left out.
RibOverlap rib_overlap(const mesh::Mesh& mesh, std::span<const ShellSection> sections);

/// A solid at its integration points.
/// @throws chladni::Error naming the element if it is turned inside out at one of them.
SolidFrame solid_of_mesh(const mesh::Mesh& mesh, const mesh::ElementBlock& block, int element);

/// The value of a profile at a place of the model, m.
/// @throws chladni::Error when a formula cannot be parsed or has no finite value there.
double value_at(const Profile& profile, const std::array<double, 3>& place);

}  // namespace chladni::plate
