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
  int group;                        ///< index into Deck::groups
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

/// What 1 is in a deck whose masses follow from its forces.
struct DeckUnits {
  double length;  ///< m
  double force;   ///< N

  double stress() const { return force / (length * length); }      ///< Pa
  double density() const { return stress() / (length * length); }  ///< kg/m^3
  double area() const { return length * length; }                  ///< m^2
  double second_moment() const { return area() * area(); }         ///< m^4
};

/// Forces in N, or in lbf where lengths are in inches.
DeckUnits units_of(double length);

/// The group of that name, made if need be.
/// @return its index
int group_index(Deck& deck, const std::string& name, int dimension);

/// An element by the shape that its number of nodes tells, which stand corners first, then the
/// middles of the edges from the first one on, as Nastran and Abaqus number them.
DeckElement surface_element(std::int64_t number, const std::vector<std::int64_t>& nodes, int group);

/// The mesh of a deck: its surfaces, and the lines of `line_groups`; other lines are sets of nodes,
/// as is said in a note. Nodes of no element are left out.
/// @throws chladni::Error naming an element and its node that is not there, and for a deck without
///         elements.
Mesh mesh_of(const Deck& deck, const std::vector<std::string>& line_groups);

}  // namespace chladni::mesh
