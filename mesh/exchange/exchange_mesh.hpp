#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/decks/deck.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// A named set of nodes and elements, either of which may be empty.
struct ExchangeGroup {
  std::string name;
  std::vector<std::int64_t> nodes = {};
  std::vector<std::size_t> elements = {};  ///< places in ExchangeMesh::elements
};

/// A mesh with its groups, as formats have it that carry meshes from one program to another: an
/// element may be of several groups, or of none.
struct ExchangeMesh {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::vector<DeckElement> elements;  ///< `group` is -1
  std::vector<ExchangeGroup> groups;
  std::vector<std::string> notes;
};

/// An element whose nodes stand corners first; a quadrilateral may lack its inner node.
/// @param order  1 to 4
/// @throws chladni::Error when it has another number of nodes.
DeckElement exchange_element(std::int64_t number, Shape shape, int order,
                             const std::vector<std::int64_t>& nodes);

/// What to do about a solid, as a half sentence that follows what the element is.
extern const char* const solids_are_not_read;

/// The group of elements, or of nodes alone, of that name, made if need be; whoever asks adds to
/// it.
enum class Members { nodes, elements };
ExchangeGroup& exchange_group(ExchangeMesh& mesh, const std::string& name, Members members);

/// Each element gets one group: that which a section names (`shell_groups`, `line_groups`), else
/// the first that it is in. All groups hold the nodes of their elements. Surfaces are the group
/// "surfaces" where none is in a group; lines without a group are left out.
/// @throws chladni::Error naming groups that hold lines and surfaces or bear one name, and an
///         element with two sections.
Deck deck_of(const ExchangeMesh& mesh, const MeshOptions& options);

}  // namespace chladni::mesh
