#pragma once

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// The mesh of a deck in its own unit, and what it says besides, in SI units, read in this process.
/// @throws chladni::Error naming file, line and card of what is wrong or not known.
Mesh deck_mesh(const MeshOptions& options);
Declarations declarations_here(const MeshOptions& options, const DeckUnits& units);

}  // namespace chladni::mesh
