// Do the readers of decks end in anything but a mesh, declarations or an error that says what is
// wrong?
#include <string>

#include "common/error.hpp"
#include "mesh/decks/abaqus.hpp"
#include "mesh/decks/ansys.hpp"
#include "mesh/decks/nastran.hpp"

namespace {

using namespace chladni::mesh;

void feed_nastran(const std::string& text)
{
  const std::vector<Card> cards = nastran_cards(text);
  const Deck deck = nastran_deck(cards);
  mesh_of(deck, {.line_groups = {"pbar_8"}});
  nastran_declarations(cards, deck, {.length = 1e-3, .force = 1.0});
}

void feed_abaqus(const std::string& text)
{
  const std::vector<Keyword> keywords = abaqus_keywords(text);
  const Deck deck = abaqus_deck(keywords);
  mesh_of(deck, {.line_groups = {"RIB"}});
  abaqus_declarations(keywords, deck, {.length = 1e-3, .force = 1.0});
}

void feed_ansys(const std::string& text)
{
  mesh_of(ansys_deck(text), {});
  ansys_declarations(text, refuse_included, {.length = 1e-3, .force = 1.0});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  for (void (*feed)(const std::string&) : {feed_nastran, feed_abaqus, feed_ansys}) {
    try {
      feed(text);
    } catch (const chladni::Error&) {
    }
  }
  return 0;
}
