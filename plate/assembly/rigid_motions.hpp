#pragma once

#include "plate/assembly/assemble.hpp"

namespace chladni::plate {

/// The mean position of all nodes, m. The rotations of `rigid_motions` turn about axes through it.
Eigen::Vector3d centre_of_nodes(const DofMap& dofs);

/// Unit translations along x, y, z and unit rotations about axes through the centre of the nodes,
/// as motions of the DOFs. Components that the nodes do not have are left out.
/// @param system  without averages and harmonics of rings, whose DOFs are no displacements of nodes
/// @return [n x 6] dense
/// @note   Collective.
petsc::Matrix rigid_motions(const System& system);

}  // namespace chladni::plate
