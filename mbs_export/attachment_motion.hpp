#pragma once

#include <Eigen/Core>
#include <string>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Displacement and rotation of each attachment node in modes T [n_FE x n]. Row 6 node + component;
/// components that the system does not have are zero.
/// @return [6 n_nodes x n]
Eigen::MatrixXd attachment_motion(const ReducedSystem& reduced, const Eigen::MatrixXd& T);

/// True if the system has this component of an attachment node, as a master or by the harmonics of
/// its ring.
bool has_component(const ReducedSystem& reduced, int node, int component);

/// The number 6 node + component of a DOF.
/// @throws chladni::Error when the system does not have it.
int attachment_dof(const ReducedSystem& reduced, int node, int component);

/// The row of K_r that is this DOF alone; absent if the DOF is a sum of harmonics.
std::optional<int> master_row(const ReducedSystem& reduced, int node, int component);

/// The masters of a motion of the attachment nodes that the masters can represent.
/// @param motion  [6 n_nodes x n]
/// @return [n_m x n]
Eigen::MatrixXd masters_of_motion(const ReducedSystem& reduced, const Eigen::MatrixXd& motion);

/// The name "x", "y", "z", "rx", "ry", "rz" of component 0 to 5.
const char* component_name(int component);

}  // namespace chladni::mbs_export
