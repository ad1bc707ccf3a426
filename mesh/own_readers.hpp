#pragma once

#include <string>

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// Whether a mesh file is a deck or an exchange file, which need no Gmsh.
bool has_own_reader(const std::string& file);

/// The mesh, in metres, of such a file, read in this process.
/// @throws chladni::Error naming the file and what is wrong with it, of a deck with line and card.
Mesh read_here(const MeshOptions& options);

/// Reads the contents of a deck besides its mesh in SI units, in this process.
/// @throws chladni::Error as `declarations`.
Declarations declarations_here(const MeshOptions& options, const DeckUnits& units);

/// Its coordinates times so many metres.
void scale(Mesh& mesh, double metres);

}  // namespace chladni::mesh
