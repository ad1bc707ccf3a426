#pragma once

#include <span>

#include "mesh/decks/abaqus_keywords.hpp"
#include "mesh/decks/deck.hpp"

/// Input files of Abaqus, and of CalculiX where both agree.

namespace chladni::mesh {

/// Node and element sets by name, in capitals.
struct AbaqusSets {
  std::map<std::string, std::vector<std::int64_t>> nodes, elements;
};

/// Reads nodes, elements and groups. The elements of a section get the group of its element set;
/// other groups have the names of their sets, with NAME_nodes for a node set that shares its name
/// with an element set. A surface gives the group `surface_NAME` of its nodes, a node that a
/// boundary condition names by its number gives `boundary_17`. Reads couplings too.
/// @throws chladni::Error naming line and keyword of a mistake, and of every unknown keyword.
Deck abaqus_deck(std::span<const Keyword> keywords);

/// Reads sections, materials and supports, which of the steps only the first one has.
/// @throws chladni::Error naming line and keyword of anything that a scene cannot express.
Declarations abaqus_declarations(std::span<const Keyword> keywords, const Deck& deck,
                                 const DeckUnits& units);

/// The name of the group of a node set.
std::string name_of_node_set(const std::string& set, const AbaqusSets& sets);

/// The sets defined before the first step.
AbaqusSets abaqus_sets(std::span<const Keyword> keywords);

/// The keywords before the first step, which define the model.
std::span<const Keyword> abaqus_model(std::span<const Keyword> keywords);

/// The nodes of the set `name`, or the single node if `name` is a number.
/// @param keyword, row  where the name stands, for the message
/// @throws chladni::Error when there is no such set.
std::vector<std::int64_t> abaqus_nodes(const Keyword& keyword, const KeywordRow& row,
                                       std::string_view name, const AbaqusSets& sets);

}  // namespace chladni::mesh
