#pragma once

#include <functional>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

/// Gmsh reads the files of strangers in a process of its own, the program chladni-mesh-reader.
namespace chladni::mesh {

/// The mesh of the file as Gmsh gives it, in metres, read in this process.
/// @param before_reading  is called when Gmsh has opened what it needs for itself: the preferences
///                        of a toolkit, /dev/null
/// @throws chladni::Error as read_gmsh.
Mesh read_here(const MeshOptions& options, const std::function<void()>& before_reading);

/// The same, read by chladni-mesh-reader, which starts no program, writes no file, and ends when it
/// takes too much time or memory.
/// @throws chladni::Error as read_here, and when that process did not come to its end.
Mesh read_confined(const MeshOptions& options);

/// What chladni-mesh-reader is asked for.
enum class Wanted { mesh, declarations };

/// What chladni-mesh-reader does: takes the options from stdin and answers with the mesh, or with
/// what a deck declares, or with the message of an error.
/// @return its exit code
int answer_with_mesh();

}  // namespace chladni::mesh
