#pragma once

#include <string>

/// Checks of a mesh file before Gmsh reads it.
namespace chladni::mesh {

/// Returns all bytes of a file.
std::string read_all(const std::string& file);

/// Checks that a .msh is complete.
/// @throws chladni::Error when it does not begin as a .msh (Gmsh would take it for GEO code), when
///         a section does not end, or when a text file gives a node number that is not one.
void check_msh_is_whole(const std::string& file);

}  // namespace chladni::mesh
