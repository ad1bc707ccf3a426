#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/complete_elements.hpp"
#include "mesh/decks/deck.hpp"
#include "mesh/split_quadrilaterals.hpp"

namespace chladni::mesh {
namespace {

using NodeIndex = std::unordered_map<std::int64_t, int>;

NodeIndex add_nodes(Mesh& mesh, const Deck& deck)
{
  NodeIndex index;
  for (const auto& [number, x] : deck.nodes) {
    index.emplace(number, mesh.n_nodes());
    mesh.node_numbers.push_back(number);
    mesh.positions.push_back(x);
  }
  return index;
}

ElementBlock& block_of(Mesh& mesh, const DeckElement& element)
{
  const auto is_alike = [&](const ElementBlock& block) {
    return block.shape == element.shape && block.order == element.order;
  };
  const auto found = std::ranges::find_if(mesh.blocks, is_alike);
  if (found != mesh.blocks.end()) return *found;
  mesh.blocks.push_back({.shape = element.shape,
                         .order = element.order,
                         .nodes_per_element = static_cast<int>(element.nodes.size()),
                         .numbers = {},
                         .nodes = {},
                         .group = {}});
  return mesh.blocks.back();
}

/// The indices of an element's nodes, -1 for those that its file does not have.
std::vector<int> nodes_of(const DeckElement& element, const NodeIndex& index)
{
  std::vector<int> nodes;
  for (const std::int64_t number : element.nodes) {
    const auto found = index.find(number);
    if (number != 0 && found == index.end())
      throw Error(fmt::format("element {}: its node {} is not there", element.number, number));
    nodes.push_back(number == 0 ? -1 : found->second);
  }
  return nodes;
}

void add_element(Mesh& mesh, const DeckElement& element, const std::vector<int>& nodes)
{
  ElementBlock& block = block_of(mesh, element);
  block.numbers.push_back(element.number);
  block.group.push_back(element.group);
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
}

void add_elements(Mesh& mesh, const Deck& deck, const NodeIndex& index,
                  const std::vector<std::string>& line_groups)
{
  std::vector<int> n_left_out(deck.groups.size(), 0);
  for (const DeckElement& element : deck.elements) {
    const std::vector<int> nodes = nodes_of(element, index);
    if (element.group < 0) {
      add_element(mesh, element, nodes);
      continue;
    }
    Group& group = mesh.groups[static_cast<std::size_t>(element.group)];
    std::ranges::copy_if(nodes, std::back_inserter(group.nodes),
                         [](int node) { return node >= 0; });
    const bool is_wanted = element.shape != Shape::line ||
                           std::ranges::find(line_groups, group.name) != line_groups.end();
    if (!is_wanted) {
      ++n_left_out[static_cast<std::size_t>(element.group)];
      continue;
    }
    add_element(mesh, element, nodes);
  }
  for (std::size_t i = 0; i < n_left_out.size(); ++i) {
    if (n_left_out[i] == 0) continue;
    mesh.notes.push_back(fmt::format(
        "{} line elements of \"{}\" became a set of nodes, since no section of type beam names it",
        n_left_out[i], mesh.groups[i].name));
  }
}

void add_groups_of_nodes(Mesh& mesh, const Deck& deck, const NodeIndex& index)
{
  for (std::size_t i = 0; i < deck.groups.size(); ++i) {
    std::vector<int>& nodes = mesh.groups[i].nodes;
    for (const std::int64_t number : deck.groups[i].nodes) {
      const auto found = index.find(number);
      if (found == index.end()) {
        throw Error(
            fmt::format("group \"{}\": its node {} is not there", deck.groups[i].name, number));
      }
      nodes.push_back(found->second);
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

/// Lattice place of each node of a surface, corners first, then the middles of the edges.
std::vector<int> lattice_places(std::size_t n_nodes)
{
  switch (n_nodes) {
    case 3:
      return {0, 1, 2};
    case 4:
      return {0, 1, 3, 2};
    case 6:
      return {0, 2, 5, 1, 4, 3};
    default:
      return {0, 2, 8, 6, 1, 5, 7, 3};
  }
}

int n_quadrilaterals(const Mesh& mesh)
{
  int n = 0;
  for (const ElementBlock& block : mesh.blocks)
    if (block.shape == Shape::quadrilateral) n += block.n_elements();
  return n;
}

/// As in files that Gmsh reads, and said in a note.
Mesh with_flat_corners_split(Mesh mesh)
{
  const int n_before = n_quadrilaterals(mesh);
  Mesh split = split_flat_corners(std::move(mesh));
  const int n_split = n_before - n_quadrilaterals(split);
  if (n_split > 0) {
    split.notes.push_back(fmt::format(
        "{} quadrilaterals with a corner of more than 165 degrees are two triangles each",
        n_split));
  }
  return split;
}

}  // namespace

int group_index(Deck& deck, const std::string& name, int dimension)
{
  const auto found = std::ranges::find(deck.groups, name, &DeckGroup::name);
  if (found != deck.groups.end()) return static_cast<int>(found - deck.groups.begin());
  deck.groups.push_back({.name = name, .dimension = dimension, .nodes = {}});
  return static_cast<int>(deck.groups.size()) - 1;
}

DeckElement surface_element(std::int64_t number, const std::vector<std::int64_t>& nodes, int group)
{
  const bool is_triangle = nodes.size() == 3 || nodes.size() == 6;
  const int order = nodes.size() > 4 ? 2 : 1;
  const std::vector<int> places = lattice_places(nodes.size());
  const std::size_t n_lattice = nodes.size() == 8 ? 9 : nodes.size();
  DeckElement element{.number = number,
                      .shape = is_triangle ? Shape::triangle : Shape::quadrilateral,
                      .order = order,
                      .nodes = std::vector<std::int64_t>(n_lattice, 0),
                      .group = group};
  for (std::size_t k = 0; k < nodes.size(); ++k)
    element.nodes[static_cast<std::size_t>(places[k])] = nodes[k];
  return element;
}

Mesh mesh_of(const Deck& deck, const std::vector<std::string>& line_groups)
{
  Mesh mesh;
  const NodeIndex index = add_nodes(mesh, deck);
  for (const DeckGroup& group : deck.groups)
    mesh.groups.push_back({.name = group.name, .dimension = group.dimension, .nodes = {}});
  add_elements(mesh, deck, index, line_groups);
  add_groups_of_nodes(mesh, deck, index);
  if (mesh.blocks.empty()) {
    throw Error(
        "it has neither shell elements nor beams of the group of a beam section; see "
        "docs/how-to/meshes.md for what can be read");
  }
  mesh.notes.insert(mesh.notes.begin(), deck.notes.begin(), deck.notes.end());
  add_inner_nodes(mesh);
  drop_unused_nodes(mesh);
  for (const Group& group : mesh.groups) {
    if (!group.nodes.empty()) continue;
    mesh.notes.push_back(
        fmt::format("group \"{}\" is left out: no element has a node of it", group.name));
  }
  return with_flat_corners_split(std::move(mesh));
}

}  // namespace chladni::mesh
