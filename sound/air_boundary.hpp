#pragma once

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// Finds the boundary faces and nodes of a mesh: on the outer sphere, on the axis or in the plane
/// of symmetry; all other free faces belong to the body.
/// @param sheet_radius  radius of a thin disc in the plane of symmetry, m; it belongs to the body
AirMesh with_boundary(AirMesh mesh, double sheet_radius);

}  // namespace chladni::sound
