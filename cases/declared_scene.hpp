#pragma once

#include <string>

#include "mesh/decks/declarations.hpp"

namespace chladni::cases {

/// The first entries of a scene that is made from a deck.
struct DeckScene {
  std::string name;         ///< of the scene
  std::string file;         ///< the deck, as the scene names it
  std::string length_unit;  ///< "mm", as the scene writes it
};

/// A scene, as TOML, with the sections, materials, couplings and supports that a deck declares. It
/// is checked like one of a user when it is read.
std::string declared_scene(const mesh::Declarations& declared, const DeckScene& scene);

}  // namespace chladni::cases
