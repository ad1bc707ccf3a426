#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "plate/dofs/dof_map.hpp"

namespace chladni::cases {

/// Returns the rows of the transformation for a list of DOFs, [n x n_FE].
using RowsOf = std::function<Eigen::MatrixXd(const std::vector<int>& dofs)>;

/// The rows of the transformation on this rank.
struct OwnRows {
  Eigen::Index n_columns;
  std::function<bool(int dof)> has;
  RowsOf rows_of;  ///< zero for DOFs that this rank does not have
};

/// A mesh and its DOFs.
struct MeshedDofs {
  const mesh::Mesh& mesh;
  const plate::DofMap& dofs;
};

/// Displacement and rotation of nodes per unit of each reduced coordinate: row 6 k + c is component
/// c of nodes[k]. Dependent nodes follow their reference nodes; components that the model does not
/// have are zero.
/// @return [6 n x n_FE], m and rad per unit of each coordinate
Eigen::MatrixXd node_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                          const RowsOf& rows_of);

/// The displacements alone, row 3 k + c.
/// @return [3 n x n_FE], m per unit of each coordinate
Eigen::MatrixXd displacement_rows(const std::vector<int>& nodes, const plate::DofMap& dofs,
                                  const RowsOf& rows_of);

}  // namespace chladni::cases
