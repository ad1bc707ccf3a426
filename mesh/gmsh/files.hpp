#pragma once

#include <string>
#include <vector>

#include "mesh/mesh_options.hpp"

/// The treatment of each format that Gmsh reads. The functions that open a file need an open
/// session of Gmsh (mesh_with_gmsh) and return notes for the user.
namespace chladni::mesh {

/// Opens a .geo with its parameters, as `gmsh -setnumber` does. Algorithm 8 (frontal-Delaunay for
/// quads), which crashes in Gmsh 4.8.4, is replaced by 6.
/// @throws chladni::Error when the .geo lacks a parameter or overwrites it, when it meshes by
///         itself with algorithm 8, and when it is a stranger's and would act on other files.
std::vector<std::string> open_geo(const MeshOptions& options);

/// Imports the surfaces of a .step in millimetres, joins surfaces that touch, cuts the rings into
/// them, and names the groups. `options.groups` number entities as the file does.
/// @throws chladni::Error when the file holds solids or no surface.
std::vector<std::string> open_step(const MeshOptions& options);

/// Adds the groups of the options to a .msh or .geo. If the file has no groups, each entity gets
/// one.
/// @throws chladni::Error naming an entity that does not exist or has another group.
void add_entity_groups(const MeshOptions& options);

}  // namespace chladni::mesh
