#pragma once

#include <set>

#include "mesh/decks/deck.hpp"

namespace chladni::mesh {

/// Who can hold the nodes of a deck: groups, and the reference nodes of its couplings, which are of
/// no element.
class Holders {
 public:
  explicit Holders(const Deck& deck);

  /// A reference node's name in a scene, "node_17".
  /// @throws chladni::Error where an element has the node, or another coupling.
  std::string add_reference(std::int64_t node);

  /// The groups and couplings by which a scene holds these nodes of a group.
  /// @throws chladni::Error naming a node that is of no element and no coupling.
  std::set<std::string> of(const std::string& group, const std::vector<std::int64_t>& nodes) const;

 private:
  std::set<std::int64_t> connected_, references_;
};

/// Adds a support, unless it is there.
void add_support(Declarations& all, const std::string& group, const std::vector<int>& components);

}  // namespace chladni::mesh
