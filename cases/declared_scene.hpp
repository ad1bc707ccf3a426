#pragma once

#include <string>

#include "mesh/decks/declarations.hpp"

namespace chladni::cases {

/// Where a scene begins that is made of a deck.
struct DeckScene {
  std::string name;         ///< of the scene
  std::string file;         ///< the deck, as the scene names it
  std::string length_unit;  ///< "mm", as the scene says it
};

/// A scene, as TOML, with the sections, materials, couplings and supports that a deck declares. It
/// is checked as whatever a user writes, when it is read.
std::string declared_scene(const mesh::Declarations& declared, const DeckScene& scene);

}  // namespace chladni::cases
