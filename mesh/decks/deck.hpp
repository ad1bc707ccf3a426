#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/decks/declarations.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

/// An element with the node numbers of its file.
struct DeckElement {
  std::int64_t number;
  Shape shape;
  int order;
  std::vector<std::int64_t> nodes;  ///< in lattice order; 0 for an inner node that the file lacks
  int group;                        ///< index into Deck::groups; -1 = none
  std::string place = {};           ///< "line 7"; empty where the file has no lines
};

/// A named set of nodes. For a group of elements `mesh_of` fills in the nodes.
struct DeckGroup {
  std::string name;
  int dimension;  ///< of its elements; 0 for a set of nodes
  std::vector<std::int64_t> nodes;
};

/// A reference node and the nodes that follow it as a rigid body, or whose mean it follows.
struct DeckCoupling {
  std::string entry;  ///< for messages: "line 7: RBE2 4"
  std::int64_t reference;
  std::string group;  ///< of the other nodes
  bool averages;
};

/// The mesh of a file of another FE program, with the numbers and in the length unit of the file.
struct Deck {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::vector<DeckElement> elements;
  std::vector<DeckGroup> groups;
  std::vector<DeckCoupling> couplings;
  std::vector<std::string> notes;
};

/// The index of the group of this name, which is added if missing.
int group_index(Deck& deck, const std::string& name, int dimension);

/// A surface element whose shape and order follow from its number of nodes. The nodes are given
/// corners first, then the middles of the edges, beginning at the first edge, as in Nastran and
/// Abaqus.
DeckElement surface_element(std::int64_t number, const std::vector<std::int64_t>& nodes, int group);

/// Gives elements of order 2 the middle nodes that they lack (0 in their places): that of a
/// neighbour at the same edge, or else a new one in the middle of the straight edge, in the sets
/// that have both ends of the edge, with a note.
/// @throws chladni::Error naming an element that lacks a middle node where a surface of order 1
///         begins.
void add_missing_middles(Deck& deck);

/// Makes the mesh of a deck: its surfaces, and the lines of `line_groups`. Other lines become sets
/// of nodes, and a note says so. Nodes without an element are left out, but for those of
/// `coupled_groups`; quadrilaterals with a flat corner are split (`split_flat_corners`).
/// @throws chladni::Error naming an element and its missing node, two elements with the same nodes
///         unless `doubled_elements` says what becomes of them, and for a deck without elements.
Mesh mesh_of(const Deck& deck, const MeshOptions& options);

}  // namespace chladni::mesh
