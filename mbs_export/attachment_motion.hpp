#pragma once

#include <Eigen/Core>
#include <string>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Displacement and rotation of each attachment node in modes T [n_FE x n]: row 6 node + component.
/// Components that the system does not have are zero.
/// @return [6 n_nodes x n]
Eigen::MatrixXd attachment_motion(const ReducedSystem& reduced, const Eigen::MatrixXd& T);

/// Whether the system has this component of an attachment node, as a master or by the harmonics of
/// its ring.
bool has_component(const ReducedSystem& reduced, int node, int component);

/// 6 node + component.
/// @throws chladni::Error when the system does not have it.
int attachment_dof(const ReducedSystem& reduced, int node, int component);

/// The row of K_r that is this DOF alone; absent where it is a sum of harmonics.
std::optional<int> master_row(const ReducedSystem& reduced, int node, int component);

/// Of a motion of the attachment nodes that the masters can show, [6 n_nodes x n]: the masters.
/// @return [n_m x n]
Eigen::MatrixXd masters_of_motion(const ReducedSystem& reduced, const Eigen::MatrixXd& motion);

/// "x", "y", "z", "rx", "ry", "rz" of component 0..5.
const char* component_name(int component);

}  // namespace chladni::mbs_export
