#pragma once

#include <vector>

#include "mesh/mesh.hpp"
#include "plate/elements/covariant_strains.hpp"
#include "plate/elements/element_matrices.hpp"
#include "plate/plate_options.hpp"

namespace chladni::plate {

/// Which section each group of the mesh has: indices into Structure, -1 for none.
struct SectionMap {
  std::vector<int> shell;  ///< [n_groups]
  std::vector<int> beam;   ///< [n_groups]
};

/// Checks the whole mesh, so that every rank throws or none.
/// @throws chladni::Error when an element has no section, a section has no elements, an element of
///         this shape and order does not exist, or the axes of a beam are not defined.
SectionMap map_sections(const mesh::Mesh& mesh, const Structure& structure);

/// What the matrices of an element depend on besides its nodes.
struct ElementContext {
  const SectionMap& sections;
  const Structure& structure;
  const NodeVectors& normals;  ///< [n_nodes x 3] mean_normals
};

/// K_e and M_e of an element, and where their DOFs stand.
struct PlacedMatrices {
  ElementMatrices matrices;
  NodeVectors arms;  ///< [n x 3] from the nodes of the mesh, m; empty where they stand there
};

/// Of any element of the mesh; those of a shell stand on its mid-surface, off the mesh by the
/// section's offset.
PlacedMatrices element_matrices(const mesh::Mesh& mesh, const mesh::ElementBlock& block,
                                int element, const ElementContext& context);

/// eta of an element: that of its section, or else of the material.
double loss_factor(const mesh::ElementBlock& block, int element, const ElementContext& context);

/// Whether anything of the structure has structural damping.
bool has_loss_factors(const Structure& structure);

}  // namespace chladni::plate
