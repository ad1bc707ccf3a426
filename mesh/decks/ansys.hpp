#pragma once

#include <string>

#include "mesh/decks/deck.hpp"
#include "mesh/decks/deck_text.hpp"

/// Archives of Ansys, as CDWRITE and the Mechanical program write them: blocks of nodes, elements
/// and components between commands.

namespace chladni::mesh {

/// Reads NBLOCK, EBLOCK (SOLID) and CMBLOCK. Solids are of the group `mat_1` of their material,
/// shells of `sec_2` of their section; components have their names, nodes held by D are `d_123`,
/// masses and springs `mass21_7` and `combin14_8_1`. Collapsed hexahedra and quadrilaterals become
/// the wedges, tetrahedra and triangles that they stand for.
/// @throws chladni::Error naming line and command of a mistake, of an element type that is not
///         known, and of commands that would change the mesh or couple its nodes.
Deck ansys_deck(const std::string& text, const ReadIncluded& read = refuse_included);

/// Reads materials (MP, MPDATA), sections (SECTYPE, SECDATA, SECBLOCK), supports (D), masses and
/// springs.
/// @throws chladni::Error naming line and command of anything that a scene cannot express.
Declarations ansys_declarations(const std::string& text, const ReadIncluded& read,
                                const DeckUnits& units);

}  // namespace chladni::mesh
