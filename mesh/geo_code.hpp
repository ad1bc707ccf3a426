#pragma once

#include <string>
#include <string_view>
#include <vector>

/// What has to be known of the text of a .geo before Gmsh reads it.
namespace chladni::mesh {

/// Its statements without semicolons and comments. Each run of blanks is one space, each text
/// empty.
std::vector<std::string> geo_statements(std::string_view geo);

/// Whether one of them has this word outside of longer ones.
bool has_word(const std::vector<std::string>& statements, std::string_view word);

/// Whether one is the command that meshes, `Mesh 2`.
bool has_mesh_command(const std::vector<std::string>& statements);

/// Whether one sets Mesh.Algorithm, or that of a surface, to 8.
bool sets_algorithm_8(const std::vector<std::string>& statements);

/// Whether one sets that of a surface, `MeshAlgorithm Surface {1} = 8`.
bool sets_algorithm_8_of_a_surface(const std::vector<std::string>& statements);

/// The first command that starts a program or writes a file; empty if none does. Code that another
/// file brings along is not seen here.
std::string acting_command(const std::vector<std::string>& statements);

}  // namespace chladni::mesh
