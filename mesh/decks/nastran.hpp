#pragma once

#include <map>
#include <span>
#include <string>

#include "mesh/decks/deck.hpp"
#include "mesh/decks/nastran_cards.hpp"

/// Bulk data of Nastran: NX, MSC, MYSTRAN and programs that write for them.
namespace chladni::mesh {

/// Reads nodes, elements and groups. The groups are `pshell_1`, `pbar_2`, `pbeam_3` for the
/// elements of a property; `rbe2_4`, `rbe3_5` for the nodes that follow or are averaged;
/// `spc_6_123` for the nodes whose components 1, 2, 3 the set 6 holds; `ps_123` for those that
/// their GRID holds; `set_7` for a SET1.
/// @throws chladni::Error naming line and card of a mistake, and of every unknown card.
Deck nastran_deck(std::span<const Card> cards);

/// Reads sections, materials, couplings and supports.
/// @throws chladni::Error naming line and card of anything that a scene cannot express.
Declarations nastran_declarations(std::span<const Card> cards, const Deck& deck,
                                  const DeckUnits& units);

/// A coordinate system of a deck, given in the basic system.
struct DeckSystem {
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> axes;
  bool is_cylindrical;
};

/// Coordinate systems by number; 0 is the basic one.
using DeckSystems = std::map<std::int64_t, DeckSystem>;

/// Reads CORD2R and CORD2C, which may refer to each other in any order.
/// @throws chladni::Error naming a card whose axes are degenerate or whose reference is missing.
DeckSystems nastran_systems(std::span<const Card> cards);

/// The position in the basic system of a point with coordinates x in `system`.
std::array<double, 3> basic_position(const DeckSystem& system, const std::array<double, 3>& x);

/// Nodes that an SPC or SPC1 holds, and their held components.
struct HeldNodes {
  std::int64_t set;
  std::vector<int> components;  ///< 0 to 5
  std::vector<std::int64_t> nodes;
};

/// Reads an SPC or SPC1; nodes are those of the deck.
/// @throws chladni::Error for a prescribed displacement.
std::vector<HeldNodes> held_nodes(const Card& card, const Deck& deck);

/// The nodes that a card lists from the field `first` on. Of a range those in the deck are taken,
/// as by Nastran; a node listed singly is always taken.
std::vector<std::int64_t> listed_nodes(const Card& card, std::size_t first, const Deck& deck);

/// The name "spc_1_123" of the group of a set and its held components.
std::string name_of_held(std::int64_t set, const std::vector<int>& components);

/// The name "ps_123" of the group of nodes that their GRID holds.
std::string name_of_held_by_grid(const std::vector<int>& components);

/// The name "conm2_5" of the group of the node of a CONM2.
std::string name_of_mass(const Card& card);
/// The name "celas_7_1" of the group of the node at end 1 or 2 of a spring.
std::string name_of_spring(const Card& card, int end);

/// The two nodes of a CELAS1 or CELAS2; 0 is the ground.
std::array<std::int64_t, 2> nodes_of_spring(const Card& card);

class Holders;
/// Adds masses and springs at nodes.
/// @param holders  knows the reference nodes of all couplings
/// @throws chladni::Error naming line and card of anything that a scene cannot express.
void declare_points(std::span<const Card> cards, const Deck& deck, const DeckUnits& units,
                    const Holders& holders, Declarations& all);

/// The section of a PBARL in the units of the deck, without group and material.
/// @throws chladni::Error for an unknown shape.
DeclaredBeam bar_of_shape(const Card& card);

/// The reference node and the other nodes of an RBE2 or RBE3.
struct RigidElement {
  std::int64_t reference;
  std::vector<std::int64_t> nodes;
};
RigidElement rigid_element(const Card& card);

}  // namespace chladni::mesh
