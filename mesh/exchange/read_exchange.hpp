#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// The mesh of a .unv, .med or .vtu in its own unit, read in this process.
/// @throws chladni::Error naming the file and what in it is wrong or not known.
Mesh exchange_mesh(const MeshOptions& options);

}  // namespace chladni::mesh
