#pragma once

#include <Eigen/Core>

#include "plate/assemble.hpp"

namespace chladni::plate {

/// The motion of every node, dependent ones included, from the DOFs of the system.
/// @param q  distributed as the rows of K.
/// @return [n_nodes x 6] u and theta of DofMap's nodes, on every rank; m, rad
/// @note   Collective on the communicator of `q`.
Eigen::MatrixXd node_motions(const DofMap& dofs, Vec q);

/// The forces and moments of the supports on the body, one row for each active number.
/// @param held      the DOFs that supports hold; other rows of the residual are round-off.
/// @param residual  K u - f, distributed as the rows of K.
/// @return [n_active x 6] N, N m, on every rank
/// @note   Collective on the communicator of `residual`.
Eigen::MatrixXd reactions(const DofMap& dofs, const std::vector<int>& held, Vec residual);

}  // namespace chladni::plate
