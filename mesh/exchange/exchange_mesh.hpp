#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/decks/deck.hpp"
#include "mesh/mesh.hpp"
#include "mesh/mesh_options.hpp"

namespace chladni::mesh {

/// A named set of nodes and elements, either of which may be empty.
struct ExchangeGroup {
  std::string name;
  std::vector<std::int64_t> nodes = {};
  std::vector<std::size_t> elements = {};  ///< places in ExchangeMesh::elements
};

/// A mesh with its groups, as in formats that carry meshes between programs: an element may belong
/// to several groups, or to none.
struct ExchangeMesh {
  std::map<std::int64_t, std::array<double, 3>> nodes;
  std::vector<DeckElement> elements;  ///< their `group` is -1
  std::vector<ExchangeGroup> groups;
  std::vector<std::string> notes;
};

/// What a group is looked up for: nodes alone, or elements.
enum class Members { nodes, elements };
/// The group of this name and kind of members, which is added if missing.
ExchangeGroup& exchange_group(ExchangeMesh& mesh, const std::string& name, Members members);

/// Makes elements of one type with the same nodes one element, in the groups of all of them, and
/// gives each element one group: that with a section (`solid_groups`, `shell_groups`,
/// `line_groups`), else the first that contains it. All groups hold the nodes of their elements;
/// groups of one name and kind are one. Lines and surfaces of a group that holds elements of a
/// higher dimension too form the groups NAME_lines and NAME_faces. If no surface or no solid is in
/// a group, all form the group "surfaces" or "volumes"; lines without a group are left out.
/// @throws chladni::Error naming groups that share a name, and an element with two sections.
Deck deck_of(ExchangeMesh mesh, const MeshOptions& options);

/// Makes the mesh by its deck.
/// @throws chladni::Error as `deck_of` and the `mesh_of` of a deck.
Mesh mesh_of(ExchangeMesh mesh, const MeshOptions& options);

/// Reads the mesh of a .unv or .med in its own unit, in this process.
/// @throws chladni::Error naming the file and its part that is wrong or unknown.
Mesh exchange_mesh(const MeshOptions& options);

}  // namespace chladni::mesh
