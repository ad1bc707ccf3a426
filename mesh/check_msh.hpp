#pragma once

#include <string>

/// What has to be known of a mesh file before Gmsh reads it.
namespace chladni::mesh {

/// All bytes of a file.
std::string read_all(const std::string& file);

/// @throws chladni::Error when a .msh does not begin as one, for Gmsh would take it for GEO code;
///         when its sections do not end, and when a text numbers a node by what is no number of
///         one.
void check_msh_is_whole(const std::string& file);

}  // namespace chladni::mesh
