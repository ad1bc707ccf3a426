#pragma once

#include <functional>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Reads the mesh of a file in this process, in metres.
/// @param before_reading  is called when Gmsh has opened the files it needs for itself
/// @throws chladni::Error as `read_gmsh`.
Mesh read_file(const MeshOptions& options, const std::function<void()>& before_reading);

}  // namespace chladni::mesh
