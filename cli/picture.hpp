#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "cli/scene/scene.hpp"
#include "mbs_export/reduced_system.hpp"
#include "mesh/mesh.hpp"
#include "plate/dof_map.hpp"

namespace chladni::cli {

/// The nodes and cells of a picture: vertices only, or the whole lattice of each element.
struct PictureNodes {
  std::vector<int> nodes;                 ///< of the mesh
  std::vector<std::array<int, 4>> cells;  ///< indices into `nodes`; a triangle repeats its last one
};
PictureNodes picture_nodes(const mesh::Mesh& mesh, PictureChoice choice);

/// Rows of the transformation for a list of DOFs, [n x n_FE].
using RowsOf = std::function<Eigen::MatrixXd(const std::vector<int>& dofs)>;

/// Positions, cells and displacements; dependent nodes follow their reference nodes.
mbs_export::Picture make_picture(const PictureNodes& chosen, const plate::DofMap& dofs,
                                 const RowsOf& rows_of);

}  // namespace chladni::cli
