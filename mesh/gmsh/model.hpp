#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Calls `build` in a Gmsh session with quadrilateral recombination, meshes the model in two
/// dimensions if it has no elements yet, and returns the mesh. Where elements of such a mesh lie on
/// one another or are folded, other options of Gmsh are tried, and a note says which helped. What
/// Gmsh prints is not for the user.
/// @param order        of the elements; 0 keeps that of the model
/// @param options  groups with sections, and coupled ones; curves of other groups than
///                 `line_groups` give groups of nodes only
/// @throws chladni::Error with Gmsh's message.
Mesh mesh_with_gmsh(const std::function<void()>& build, int order, const MeshOptions& options = {});

}  // namespace chladni::mesh
