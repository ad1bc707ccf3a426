#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mbs_export/attachment_dofs.hpp"
#include "mbs_export/body_options.hpp"
#include "mbs_export/reduced_system.hpp"

namespace chladni::mbs_export {

/// Loads that get their interface modes together: one DOF, or one circumferential harmonic of a
/// ring with its cosine and sine, so that a disc keeps its symmetry.
struct LoadGroup {
  std::string name;          ///< "arm.x", "track.z, 3 diameters"
  Eigen::MatrixXd patterns;  ///< [n_loads x k], orthonormal, all forces or all moments
  /// rad/s, for its interface modes, if the scene gives it
  std::optional<double> Omega_0;
};

/// The attachment DOFs at which the scene loads the body, and the loads on them.
struct LoadedDofs {
  std::vector<int> dofs;        ///< 6 node + component, each once
  std::vector<char> is_moment;  ///< [n_loads]
  /// "track.z" for all nodes of a set; "edge.z of degree 8" where its nodes are loaded together
  std::vector<std::string> names;
  std::vector<LoadGroup> groups;
  /// [n_dofs x n_loads] forces of each load on the DOFs, orthonormal for each set and component;
  /// empty where each DOF is loaded by itself
  Eigen::MatrixXd spread = {};

  /// What the loads work on: motions of the DOFs, summed as the loads spread over them.
  /// @param motions  [n_dofs x n]
  /// @return [n_loads x n]
  Eigen::MatrixXd worked_on(const Eigen::MatrixXd& motions) const;
};

/// The loads of a scene: the DOFs of its `interface_modes`. Without these, the displacement normal
/// to the disc on every contact ring, and on every other set the components that are drilling
/// (held_modes.hpp) at none of its nodes, at those nodes where they are not held. Where sets of
/// more than 24 nodes (9, where that does not suffice) that are no contact rings have more than 96
/// of these, or all together are more than 256, the nodes of such a set are loaded together, by
/// forces that vary over it as polynomials of x, y and z, of the highest degree up to 8 that keeps
/// the numbers; rings come last. Loads that the scene names may be 256. Empty where the support
/// holds all: then the body is moved by its reactions alone.
/// @throws chladni::Error for a set or component that does not exist, is held or drilling, for
///         more sets than a selection can compare, and where nothing would be loaded although
///         something is free, as of a contact ring that is held along z alone.
LoadedDofs loaded_dofs(const ReducedSystem& reduced, const HeldDofs& held,
                       const std::vector<InterfaceModes>& wanted);

/// The number 6 node + component of a DOF that is to be loaded.
/// @throws chladni::Error when it is held or not part of the system.
int loaded_dof(const ReducedSystem& reduced, const HeldDofs& held, MasterDof loaded);

}  // namespace chladni::mbs_export
