#pragma once

#include "plate/assembly/assemble.hpp"

namespace chladni::plate {

/// Unit translations along x, y, z and unit rotations about axes through the mean of all nodes, as
/// motions of the DOFs; components that the nodes do not have are left out.
/// @param system  without averages and harmonics of rings, whose DOFs are no displacements of nodes
/// @return [n x 6] dense
/// @note   Collective.
petsc::Matrix rigid_motions(const System& system);

}  // namespace chladni::plate
