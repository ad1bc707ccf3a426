#include "mesh/own_readers.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "common/error.hpp"
#include "mesh/decks/abaqus.hpp"
#include "mesh/decks/ansys.hpp"
#include "mesh/decks/nastran.hpp"
#include "mesh/exchange/exchange_mesh.hpp"
#include "mesh/gmsh_text.hpp"

namespace chladni::mesh {
namespace {

namespace fs = std::filesystem;

/// Reads the files that a deck includes, by their paths from its folder.
ReadIncluded beside(const std::string& deck)
{
  return [folder = fs::path(deck).parent_path()](const std::string& named) {
    const fs::path file = folder / named;
    std::error_code unknown;
    if (!fs::is_regular_file(file, unknown))
      throw Error(fmt::format("the included file {} is not there", file.string()));
    return read_all(file.string());
  };
}

/// What `read` makes of the text of the file; errors get its name.
auto of_text(const MeshOptions& options, auto&& read)
{
  try {
    return read(read_all(*options.file), beside(*options.file));
  } catch (const Error& error) {
    throw Error(fmt::format("mesh file {}: {}", *options.file, error.what()));
  }
}

MeshSource source_of_deck(const MeshOptions& options)
{
  return mesh_source(options.file.value()).value();
}

/// In the length unit of the deck.
Mesh deck_mesh(const MeshOptions& options)
{
  return of_text(options, [&](const std::string& text, const ReadIncluded& included) {
    const MeshSource source = source_of_deck(options);
    return mesh_of(source == MeshSource::ansys    ? ansys_deck(text, included)
                   : source == MeshSource::abaqus ? abaqus_deck(abaqus_keywords(text, included))
                                                  : nastran_deck(nastran_cards(text, included)),
                   options);
  });
}

}  // namespace

bool has_own_reader(const std::string& file)
{
  return is_deck(file) || is_exchange(file);
}

Mesh read_here(const MeshOptions& options)
{
  Mesh mesh = is_deck(options.file.value()) ? deck_mesh(options) : exchange_mesh(options);
  scale(mesh, options.length_unit);
  return mesh;
}

void scale(Mesh& mesh, double metres)
{
  for (auto& x : mesh.positions)
    for (double& coordinate : x) coordinate *= metres;
  for (Equation& equation : mesh.equations)
    for (Equation::Term& term : equation.terms)
      if (term.component >= 3) term.factor *= metres;
}

Declarations declarations_here(const MeshOptions& options, const DeckUnits& units)
{
  return of_text(options, [&](const std::string& text, const ReadIncluded& included) {
    const MeshSource source = source_of_deck(options);
    if (source == MeshSource::ansys) return ansys_declarations(text, included, units);
    if (source == MeshSource::abaqus) {
      const std::vector<Keyword> keywords = abaqus_keywords(text, included);
      return abaqus_declarations(keywords, abaqus_deck(keywords), units);
    }
    const std::vector<Card> cards = nastran_cards(text, included);
    return nastran_declarations(cards, nastran_deck(cards), units);
  });
}

}  // namespace chladni::mesh
