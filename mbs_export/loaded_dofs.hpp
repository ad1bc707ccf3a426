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

/// The attachment DOFs at which the scene loads the body.
struct LoadedDofs {
  std::vector<int> dofs;           ///< 6 node + component, each once
  std::vector<char> is_moment;     ///< [n_loads]
  std::vector<std::string> names;  ///< [n_loads] "track.z" for all nodes of a set
  std::vector<LoadGroup> groups;
};

/// The loads of a scene: the DOFs of its `interface_modes`. Without these, the displacement normal
/// to the disc on every contact ring, and all DOFs that are neither held nor drilling
/// (drilling.hpp) on every other set.
/// @throws chladni::Error for a set or component that does not exist, is held or drilling, when no
///         DOF is left to load, and for more loads than a selection can compare.
LoadedDofs loaded_dofs(const ReducedSystem& reduced, const HeldDofs& held,
                       const std::vector<InterfaceModes>& wanted);

/// The number 6 node + component of a DOF that is to be loaded.
/// @throws chladni::Error when it is held or not part of the system.
int loaded_dof(const ReducedSystem& reduced, const HeldDofs& held, MasterDof loaded);

}  // namespace chladni::mbs_export
