#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// An element as its file numbers its nodes.
struct DeckElement {
  std::int64_t number;
  Shape shape;
  int order;
  std::vector<std::int64_t> nodes;  ///< in lattice order, 0 where the file has none
  int group;                        ///< index into Deck::groups, -1 = none
};

/// A named set of nodes. That of elements holds their nodes only after `mesh_of`.
struct DeckGroup {
  std::string name;
  int dimension;  ///< of its elements; 0 of nodes alone
  std::vector<std::int64_t> nodes;
};

/// The mesh of a file of another FE program, numbers as they stand there, in its own unit.
struct Deck {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::vector<DeckElement> elements;
  std::vector<DeckGroup> groups;
  std::vector<std::string> notes;
};

/// The group of that name, made if need be.
/// @return its index
int group_index(Deck& deck, const std::string& name, int dimension);

/// An element by the shape that its number of nodes tells, which stand corners first, then the
/// middles of the edges from the first one on, as Nastran and Abaqus number them.
DeckElement surface_element(std::int64_t number, const std::vector<std::int64_t>& nodes, int group);

/// The mesh of a deck: its surfaces, and the lines of `line_groups`; other lines are sets of nodes,
/// as is said in a note. Nodes of no element are left out, flat quadrilaterals split as those of
/// other files.
/// @throws chladni::Error naming an element and its node that is not there, and for a deck without
///         elements.
Mesh mesh_of(const Deck& deck, const std::vector<std::string>& line_groups);

}  // namespace chladni::mesh
