#pragma once

#include <array>
#include <vector>

#include "cases/fe_model.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/dofs/dof_map.hpp"
#include "scene/scene.hpp"

namespace chladni::cases {

/// The nodes and cells of a picture: vertices only, or the whole lattice of each element.
struct PictureNodes {
  std::vector<int> nodes;  ///< of the mesh
  std::vector<std::array<int, 4>>
      cells;  ///< indices into `nodes`; a triangle repeats its last one, a line twice
};
/// The nodes and cells of a mesh that a picture shows.
PictureNodes picture_nodes(const mesh::Mesh& mesh, scene::PictureChoice choice);

/// The positions, cells and displacements of a picture. Dependent nodes follow their reference
/// nodes. Each rank makes the displacements of those nodes whose DOFs it has, and the first rank
/// alone gets them.
/// @note Collective.
mbs_export::Picture make_picture(const PictureNodes& chosen, const plate::DofMap& dofs,
                                 const OwnRows& own);

}  // namespace chladni::cases
