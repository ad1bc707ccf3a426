#pragma once

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// Reads the mesh of a deck in the length unit of the deck, in this process.
/// @throws chladni::Error naming file, line and card of a mistake, or of an unknown card.
Mesh deck_mesh(const MeshOptions& options);
/// Reads the contents of a deck besides its mesh in SI units, in this process.
/// @throws chladni::Error as `declarations`.
Declarations declarations_here(const MeshOptions& options, const DeckUnits& units);

}  // namespace chladni::mesh
