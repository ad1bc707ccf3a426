#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

/// Meshes by chladni-mesher, a program of its own: Gmsh and what it needs are large, and strangers'
/// files are dangerous.
namespace chladni::mesh {

/// The mesh, in metres, of a file or of a generator whose elements Gmsh makes. A stranger's file is
/// read by a process that starts no program, writes no file, and is ended when it takes too much
/// time or memory; what its owner trusts and needs no Gmsh is read here.
/// @throws chladni::Error with what is wrong with the file or the options, and when the process did
///         not finish.
Mesh made_by_mesher(const MeshOptions& options);

}  // namespace chladni::mesh
