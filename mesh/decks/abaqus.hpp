#pragma once

#include <span>

#include "mesh/decks/abaqus_keywords.hpp"
#include "mesh/decks/deck.hpp"

/// Input files of Abaqus, and of CalculiX as far as they are the same.
namespace chladni::mesh {

/// Node and element sets as they are being read, in capitals.
struct AbaqusSets {
  std::map<std::string, std::vector<std::int64_t>> nodes, elements;
};

/// Nodes, elements and groups: that of a section for its elements; the others of their names, where
/// a node set with the name of an element set is NAME_nodes; `surface_NAME` of the nodes of a
/// surface, `boundary_17` of a node that a boundary condition names by its number.
/// @throws chladni::Error naming line and keyword of what is wrong, and of every keyword that is
///         not known.
Deck abaqus_deck(std::span<const Keyword> keywords);

/// Sections, materials, couplings, and the supports that stand before the first step.
/// @throws chladni::Error naming line and keyword of what a scene has not.
Declarations abaqus_declarations(std::span<const Keyword> keywords, const Deck& deck,
                                 const DeckUnits& units);

/// How the group of a node set is called.
std::string name_of_node_set(const std::string& set, const AbaqusSets& sets);

/// The sets of the keywords before the first step.
AbaqusSets abaqus_sets(std::span<const Keyword> keywords);

/// The keywords before the first step: the model.
std::span<const Keyword> abaqus_model(std::span<const Keyword> keywords);

/// The nodes of a set, or the one node of that number.
/// @throws chladni::Error where there is no such set.
std::vector<std::int64_t> abaqus_nodes(const Keyword& keyword, const KeywordRow& row,
                                       std::string_view name, const AbaqusSets& sets);

}  // namespace chladni::mesh
