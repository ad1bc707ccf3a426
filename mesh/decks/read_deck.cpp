#include "mesh/decks/read_deck.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "mesh/check_msh.hpp"
#include "mesh/decks/abaqus.hpp"
#include "mesh/decks/is_deck.hpp"
#include "mesh/decks/nastran.hpp"

namespace chladni::mesh {
namespace {

/// What `read` makes of the text of the file; errors get its name.
auto of_text(const MeshOptions& options, auto&& read)
{
  try {
    return read(read_all(*options.file));
  } catch (const Error& error) {
    throw Error(fmt::format("mesh file {}: {}", *options.file, error.what()));
  }
}

}  // namespace

Mesh deck_mesh(const MeshOptions& options)
{
  return of_text(options, [&](const std::string& text) {
    const Deck deck = is_abaqus(*options.file) ? abaqus_deck(abaqus_keywords(text))
                                               : nastran_deck(nastran_cards(text));
    return mesh_of(deck, options.line_groups);
  });
}

Declarations declarations_here(const MeshOptions& options, const DeckUnits& units)
{
  return of_text(options, [&](const std::string& text) {
    if (is_abaqus(*options.file)) {
      const std::vector<Keyword> keywords = abaqus_keywords(text);
      return abaqus_declarations(keywords, abaqus_deck(keywords), units);
    }
    const std::vector<Card> cards = nastran_cards(text);
    return nastran_declarations(cards, nastran_deck(cards), units);
  });
}

}  // namespace chladni::mesh
