#pragma once

#include "sound/air_mesh.hpp"

namespace chladni::sound {

/// The mesh with its boundary sorted by where it is: what is neither on the outer sphere nor on the
/// axis nor in the plane of symmetry is the body.
/// @param sheet_radius  m, of a thin disc in the plane of symmetry; it belongs to the body
AirMesh with_boundary(AirMesh mesh, double sheet_radius);

}  // namespace chladni::sound
