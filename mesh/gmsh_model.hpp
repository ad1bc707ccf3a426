#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Runs `build` inside a Gmsh session with quadrilateral recombination, meshes the model in two
/// dimensions if it has no elements yet, and returns the mesh. Gmsh's own messages stay silent.
/// @param order of the elements, or 0 to keep what the model has.
/// @param line_groups  groups of curves whose elements are kept; other curves are node groups only
/// @throws chladni::Error with Gmsh's message.
Mesh mesh_with_gmsh(const std::function<void()>& build, int order,
                    const std::vector<std::string>& line_groups = {});

}  // namespace chladni::mesh
