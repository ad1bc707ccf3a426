#pragma once

#include <string>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Whether a mesh file is a deck or an exchange file, which need no Gmsh.
bool has_own_reader(const std::string& file);

/// The mesh, in metres, of such a file.
/// @throws chladni::Error with what is wrong with the file.
Mesh read_here(const MeshOptions& options);

/// Its coordinates times so many metres.
void scale(Mesh& mesh, double metres);

}  // namespace chladni::mesh
