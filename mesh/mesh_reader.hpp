#pragma once

#include <functional>
#include <string>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

/// Reading strangers' files with Gmsh in a process of its own, the program chladni-mesh-reader.
namespace chladni::mesh {

/// Reads the mesh of a file in this process, in metres.
/// @param before_reading  is called when Gmsh has opened the files it needs for itself: the
///                        preferences of a toolkit, /dev/null
/// @throws chladni::Error as `read_gmsh`.
Mesh read_here(const MeshOptions& options, const std::function<void()>& before_reading);

/// Reads the mesh of a file by chladni-mesh-reader, which starts no program, writes no file, and is
/// ended when it takes too much time or memory.
/// @throws chladni::Error as `read_here`, and when that process did not finish.
Mesh read_confined(const MeshOptions& options);

/// The path of chladni-mesh-reader: beside this program as both are built and installed, or where
/// CHLADNI_MESH_READER says.
/// @throws chladni::Error when there is none.
std::string reader_program();

/// What chladni-mesh-reader is asked for: the mesh, or the other contents of a deck.
enum class Wanted { mesh, declarations };

/// The work of chladni-mesh-reader: takes the options from stdin and answers with the mesh, with
/// the declarations of a deck, or with the message of an error.
/// @return exit code of the program
int answer_with_mesh();

}  // namespace chladni::mesh
