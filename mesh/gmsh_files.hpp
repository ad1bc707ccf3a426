#pragma once

#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

/// What is special to each format that Gmsh reads. The functions that open a file need an open
/// session of Gmsh (mesh_with_gmsh) and return notes for the user.
namespace chladni::mesh {

/// Opens a .geo with its parameters, as `gmsh -setnumber` does. Algorithm 8 (frontal-Delaunay for
/// quads), which crashes in Gmsh 4.8.4, is replaced by 6.
/// @throws chladni::Error when the .geo does not have a parameter or overwrites it, when it meshes
///         itself by algorithm 8, and when it is a stranger's and would act on other files.
std::vector<std::string> open_geo(const MeshOptions& options);

/// Imports the surfaces of a .step in millimetres, joins what touches, cuts the rings into them,
/// and names the groups. `options.groups` count entities as the file does.
/// @throws chladni::Error when the file holds solids or no surface.
std::vector<std::string> open_step(const MeshOptions& options);

/// Adds the groups of a .msh or .geo, or one for each entity where the file has none.
/// @throws chladni::Error naming an entity that does not exist or has another group.
void add_entity_groups(const MeshOptions& options);

}  // namespace chladni::mesh
