#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

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

/// DOFs of attachment nodes whose displacement is prescribed to be zero.
struct HeldDofs {
  std::vector<int> dofs;           ///< 6 node + component, each once
  std::vector<std::string> names;  ///< "hub.rx", or "track.z (node 17)" in a set of several nodes
  /// Rows of K_r that are these DOFs, ascending; DOFs of a ring of harmonics come first, as -1.
  std::vector<int> rows;
  Eigen::MatrixXd forms;  ///< [n_c x n_FE] the held displacements if some row is -1; else empty

  /// True if all held DOFs are masters.
  bool are_masters() const { return forms.size() == 0; }
  /// The held displacements of modes.
  /// @param Q  [n_FE x n]
  /// @return [n_c x n]
  Eigen::MatrixXd displacements(const Eigen::MatrixXd& Q) const;
};

/// The DOFs that `fixed` lists as "SET" (all components) or "SET.x|y|z|rx|ry|rz".
/// @throws chladni::Error for an unknown set or component, or a component that is not part of the
///         system, naming those that exist.
HeldDofs held_dofs(const ReducedSystem& reduced, const std::vector<std::string>& fixed);

/// True if two lists, as `held_dofs` takes them, hold the same DOFs: "hub" and "rim" as "rim" and
/// "hub", or a node as its six components.
/// @throws chladni::Error as `held_dofs`, unless the lists are equal.
bool are_same_support(const ReducedSystem& reduced, const std::vector<std::string>& one,
                      const std::vector<std::string>& other);

}  // namespace chladni::mbs_export
