#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "mesh/decks/deck.hpp"
#include "mesh/decks/nastran_cards.hpp"

/// Bulk data of Nastran: NX, MSC, MYSTRAN and programs that write for them.

namespace chladni::mesh {

/// Reads nodes, elements, groups and couplings. The groups are `psolid_1`, `pshell_1`, `pbar_2`,
/// `pbeam_3` for the elements of a property; `rbe2_4`, `rbar_4`, `mpc_4_17` for the nodes that
/// follow (17 that of the equations), `rbe3_5` for those that are averaged; `spc_6_123` for the
/// nodes whose components 1, 2, 3 the set 6 holds; `ps_123` for those that their GRID holds;
/// `set_7` for a SET1.
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
  char kind;  ///< 'R' rectangular, 'C' cylindrical (r, theta, z), 'S' spherical (r, theta, phi)
};

/// Coordinate systems by number; 0 is the basic one.
using DeckSystems = std::map<std::int64_t, DeckSystem>;

/// Reads CORD1R, CORD1C, CORD1S by their grids, and CORD2R, CORD2C and CORD2S, which may refer to
/// each other in any order.
/// @throws chladni::Error naming a card whose axes are degenerate or whose reference is missing.
DeckSystems nastran_systems(std::span<const Card> cards);

/// The position in the basic system of a point with coordinates x in `system`.
std::array<double, 3> basic_position(const DeckSystem& system, const std::array<double, 3>& x);

/// The axes of a system at a point of the basic system: of a cylindrical one e_r, e_theta, e_z.
DeckAxes axes_at(const DeckSystem& system, const std::array<double, 3>& x);

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
/// The name "celas_7_1", or "cbush_7_1", of the group of the node at end 1 or 2 of a spring.
std::string name_of_spring(const Card& card, int end);

/// The two nodes of a CELAS1, CELAS2 or CBUSH; 0 is the ground.
std::array<std::int64_t, 2> nodes_of_spring(const Card& card);

bool is_rod(const Card& card);
/// The nodes of a CROD or CONROD.
std::array<std::int64_t, 2> nodes_of_rod(const Card& card);
/// The name "rod_8" of the group of the elongation of a rod, or of its end 1 or 2, "rod_8_1".
std::string name_of_rod(const Card& card, int end);

class Holders;
/// Adds masses and springs at nodes.
/// @param holders  knows the reference nodes of all couplings
/// @throws chladni::Error naming line and card of anything that a scene cannot express.
void declare_points(std::span<const Card> cards, const Deck& deck, const DeckUnits& units,
                    const Holders& holders, Declarations& all);

/// The section of a PBARL in the units of the deck, without group and material.
/// @throws chladni::Error for an unknown shape.
DeclaredBeam bar_of_shape(const Card& card);

/// The vector of a CBAR or CBEAM, towards Nastran's y axis, of length 1, in the basic system.
/// @throws chladni::Error when it has none
std::array<double, 3> vector_of_beam(const Card& card, const Deck& deck);

/// The components that the field PS of a GRID holds.
std::vector<int> held_by_grid(const Card& card);

/// The sets SPC or MPC of which the analysis consists: those that case control chooses (`word` is
/// SPC or MPC), or the only one of the bulk data.
struct ChosenSets {
  std::set<std::int64_t> sets;
  std::vector<std::string> notes;  ///< for the user: of sets that are left out
};
/// @throws chladni::Error when there are several sets and none is chosen, or the chosen one is not
///         there.
ChosenSets chosen_sets(std::span<const Card> cards, const std::string& word);

/// The reference node of a rigid element or an average, and its other nodes.
struct RigidElement {
  std::string group;  ///< name of the group of the nodes
  std::int64_t reference;
  std::vector<std::int64_t> nodes;
  const Card* card;  ///< the first one of it
  /// Of one that is no coupling of a scene: what follows, or is averaged.
  std::vector<int> components = {};
  std::map<std::int64_t, double> weights = {};  ///< of an average, by node

  bool is_of_equations() const { return !components.empty(); }
  bool averages() const { return card->name() == "RBE3"; }
  /// An average of displacements alone, which leaves the rotations of its reference node free.
  bool is_of_displacements() const { return averages() && card->components(4).size() == 3; }
};

/// Reads RBE2, RBE3, RBAR and the equations (MPC) of the chosen set of which six of two terms each
/// make a rigid link.
/// @throws chladni::Error for a bar that is not wholly rigid, or averages of rotations.
std::vector<RigidElement> rigid_elements(std::span<const Card> cards, const Deck& deck);

/// Reads the other equations (MPC) of the chosen set.
std::vector<DeckEquation> equations_of_cards(std::span<const Card> cards, const Deck& deck);

}  // namespace chladni::mesh
