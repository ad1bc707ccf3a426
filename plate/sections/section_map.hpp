#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/beam_fields.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/element_matrices.hpp"
#include "plate/plate_options.hpp"
#include "plate/sections/directors.hpp"

namespace chladni::plate {

/// The section of each group of the mesh as an index into Structure; -1 for none.
struct SectionMap {
  std::vector<int> shell;        ///< [n_groups]
  std::vector<int> beam;         ///< [n_groups]
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

}  // namespace chladni::plate
