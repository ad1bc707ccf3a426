#pragma once

#include <set>

#include "mesh/decks/deck.hpp"

namespace chladni::mesh {

/// Finds by which groups and couplings a scene can hold nodes of a deck. Reference nodes of
/// couplings belong to no element.
class Holders {
 public:
  explicit Holders(const Deck& deck);

  /// Registers the reference node of a coupling.
  /// @return its name in a scene, "node_17"
  /// @throws chladni::Error when the node belongs to an element or to another coupling.
  std::string add_reference(std::int64_t node);

  /// The groups and couplings by which a scene holds some nodes of `group`.
  /// @throws chladni::Error naming a node that belongs to no element and no coupling.
  std::set<std::string> of(const std::string& group, const std::vector<std::int64_t>& nodes) const;

 private:
  std::set<std::int64_t> connected_, references_;
};

/// Adds a support unless there is an equal one.
void add_support(Declarations& all, const std::string& group, const std::vector<int>& components);

}  // namespace chladni::mesh
