#pragma once

#include <map>
#include <span>
#include <string>

#include "mesh/decks/deck.hpp"
#include "mesh/decks/nastran_cards.hpp"

/// Bulk data of Nastran: NX, MSC, MYSTRAN and what writes for them.
namespace chladni::mesh {

/// Nodes, elements and groups: `pshell_1`, `pbar_2`, `pbeam_3` of the elements of a property,
/// `rbe2_4`, `rbe3_5` of the nodes that follow or are averaged, `spc_6_123` of the nodes whose
/// components 1, 2, 3 the set 6 holds, `ps_123` of those that their GRID holds, `set_7` of SET1.
/// @throws chladni::Error naming line and card of what is wrong, and of every card that is not
///         known.
Deck nastran_deck(std::span<const Card> cards);

/// Sections, materials, couplings and supports.
/// @throws chladni::Error naming line and card of what a scene has not.
Declarations nastran_declarations(std::span<const Card> cards, const Deck& deck,
                                  const DeckUnits& units);

/// A coordinate system of a deck, in the basic one.
struct DeckSystem {
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> axes;
  bool is_cylindrical;
};

/// Coordinate systems by number, the basic one, 0, among them.
using DeckSystems = std::map<std::int64_t, DeckSystem>;

/// CORD2R and CORD2C, in whatever order they refer to each other.
/// @throws chladni::Error naming the card whose axes are none, or whose reference is not there.
DeckSystems nastran_systems(std::span<const Card> cards);

/// The position of what has these coordinates in a system.
std::array<double, 3> basic_position(const DeckSystem& system, const std::array<double, 3>& x);

/// The nodes of a SPC or SPC1 and the components that it holds of each.
struct HeldNodes {
  std::int64_t set;
  std::vector<int> components;  ///< 0 to 5
  std::vector<std::int64_t> nodes;
};

/// What an SPC or SPC1 holds, of the nodes of the deck.
/// @throws chladni::Error where a displacement is prescribed.
std::vector<HeldNodes> held_nodes(const Card& card, const Deck& deck);

/// The nodes that a card lists from a field on. Of a range those that are in the deck, as Nastran
/// takes it; what stands there by itself is taken in any case.
std::vector<std::int64_t> listed_nodes(const Card& card, std::size_t first, const Deck& deck);

/// "spc_1_123": how the group of a set and its components is called.
std::string name_of_held(std::int64_t set, const std::vector<int>& components);

/// "ps_123": nodes that a GRID itself holds.
std::string name_of_held_by_grid(const std::vector<int>& components);

/// "conm2_5", "celas_7_1": the groups of the nodes of a CONM2, and of the ends 1 and 2 of a spring.
std::string name_of_mass(const Card& card);
std::string name_of_spring(const Card& card, int end);

/// Of a CELAS1 or CELAS2; 0 for the ground.
std::array<std::int64_t, 2> nodes_of_spring(const Card& card);

class Holders;
/// Masses and springs at nodes.
/// @param holders  with the reference nodes of all couplings
/// @throws chladni::Error naming line and card of what a scene has not.
void declare_points(std::span<const Card> cards, const Deck& deck, const DeckUnits& units,
                    const Holders& holders, Declarations& all);

/// The section of a PBARL in the units of the deck, without group and material.
/// @throws chladni::Error for a shape that is not known.
DeclaredBeam bar_of_shape(const Card& card);

/// The nodes of an RBE2 or RBE3.
struct RigidElement {
  std::int64_t reference;
  std::vector<std::int64_t> nodes;
};
RigidElement rigid_element(const Card& card);

}  // namespace chladni::mesh
