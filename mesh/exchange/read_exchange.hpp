#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Reads the mesh of a .unv, .med or .vtu in its own unit, in this process.
/// @throws chladni::Error naming the file and its part that is wrong or unknown.
Mesh exchange_mesh(const MeshOptions& options);

}  // namespace chladni::mesh
