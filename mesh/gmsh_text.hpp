#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Checks of a mesh file before Gmsh reads it.

namespace chladni::mesh {

/// Returns all bytes of a file.
std::string read_all(const std::string& file);

/// Checks that a .msh is complete.
/// @throws chladni::Error when it does not begin as a .msh (Gmsh would take it for GEO code), when
///         a section does not end, or when a text file gives a node number that is not one.
void check_msh_is_whole(const std::string& file);

}  // namespace chladni::mesh

/// Checks of the text of a .geo before Gmsh reads it.

namespace chladni::mesh {

/// The statements of a .geo without semicolons and comments. Each run of blanks becomes one space,
/// each quoted text becomes empty.
std::vector<std::string> geo_statements(std::string_view geo);

/// True if a statement contains `word` as a whole word.
bool has_word(const std::vector<std::string>& statements, std::string_view word);

/// True if a statement is the command that meshes, `Mesh 2`.
bool has_mesh_command(const std::vector<std::string>& statements);

/// True if a statement sets Mesh.Algorithm, or the algorithm of a surface, to 8.
bool sets_algorithm_8(const std::vector<std::string>& statements);

/// True if a statement sets the algorithm of a surface to 8, as `MeshAlgorithm Surface {1} = 8`.
bool sets_algorithm_8_of_a_surface(const std::vector<std::string>& statements);

/// The first command that starts a program or writes a file; empty if there is none. Files that the
/// .geo includes are not looked at.
std::string acting_command(const std::vector<std::string>& statements);

}  // namespace chladni::mesh
