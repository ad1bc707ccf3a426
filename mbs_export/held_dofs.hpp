#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// DOFs of attachment nodes whose displacement is prescribed to be zero.
struct HeldDofs {
  std::vector<int> dofs;           ///< 6 node + component, each once
  std::vector<std::string> names;  ///< "hub.rx", or "track.z (node 17)" in a set of several nodes
  /// Rows of K_r that are these DOFs, ascending; -1 for a DOF of a ring of harmonics, first
  std::vector<int> rows;
  Eigen::MatrixXd forms;  ///< [n_c x n_FE] the displacements where some row is -1; else empty

  bool are_masters() const { return forms.size() == 0; }
  /// The held displacements of modes Q [n_FE x n].
  Eigen::MatrixXd displacements(const Eigen::MatrixXd& Q) const;
};

/// The DOFs of "SET" (all components) or "SET.x|y|z|rx|ry|rz" in each entry of `fixed`.
/// @throws chladni::Error naming what exists, for an unknown set or component, or a component
///         that is not part of the system.
HeldDofs held_dofs(const ReducedSystem& reduced, const std::vector<std::string>& fixed);

/// Whether two lists, as `held_dofs` takes them, hold the same DOFs: "hub" and "rim", "rim" and
/// "hub", a node and its six components.
/// @throws chladni::Error as held_dofs, unless the lists are equal.
bool are_same_support(const ReducedSystem& reduced, const std::vector<std::string>& one,
                      const std::vector<std::string>& other);

}  // namespace chladni::mbs_export
