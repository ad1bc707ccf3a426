#pragma once

#include <set>

#include "mesh/decks/deck.hpp"

namespace chladni::mesh {

/// Finds by which groups and couplings a scene can hold nodes of a deck.
class Holders {
 public:
  /// Knows the nodes of elements and those that follow others.
  explicit Holders(const Deck& deck);

  bool is_follower(std::int64_t node) const { return followers_.contains(node); }
  /// True if an element has the node, or it follows another one: then it is a node of the mesh.
  bool is_in_mesh(std::int64_t node) const
  {
    return connected_.contains(node) || is_follower(node);
  }
  bool is_reference(std::int64_t node) const { return references_.contains(node); }
  void add_reference(std::int64_t node) { references_.insert(node); }

  /// The groups and couplings by which a scene holds some nodes of `group`.
  /// @throws chladni::Error naming a node that belongs to no element and no coupling.
  std::set<std::string> of(const std::string& group, const std::vector<std::int64_t>& nodes) const;

 private:
  std::set<std::int64_t> connected_, followers_, references_;
};

/// The nodes that can be held. Those of no element and no coupling are held for nobody, as in other
/// programs, which a note tells.
/// @param entry  for the note: "line 7: SPC1 4"
std::vector<std::int64_t> supported_nodes(const Holders& holders, const std::string& entry,
                                          const std::vector<std::int64_t>& nodes,
                                          Declarations& all);

/// Adds a group "leader_17" for each node of the mesh that others follow as a rigid body.
void add_leaders(Deck& deck);

/// Adds the couplings of a deck, and registers their reference nodes.
/// @throws chladni::Error naming an entry whose reference is no node, or whose mean a scene cannot
///         express.
void declare_couplings(const Deck& deck, const DeckUnits& units, Holders& holders,
                       Declarations& all);

/// Adds a support unless there is an equal one.
void add_support(Declarations& all, const std::string& group, const std::vector<int>& components);

}  // namespace chladni::mesh
