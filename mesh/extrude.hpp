#pragma once

#include <span>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Layers of solids over a plane mesh at z = 0: hexahedra over quadrilaterals, wedges over
/// triangles, of its order. Groups go up by one dimension: that of the surfaces becomes one of
/// solids, edges become faces and points become lines, with the nodes above one another;
/// "bottom_face" and "top_face" are added, and the rings at `RingOptions::z`, or at `to`. Over one
/// of several sectors they are this sector of the solid.
/// @param flat  without rings
/// @throws chladni::Error as `add_rings`.
Mesh extruded(const Mesh& flat, const Extrusion& extrusion, std::span<const RingOptions> rings);

}  // namespace chladni::mesh
