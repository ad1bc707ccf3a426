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
