#include "mesh/exchange/exchange_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "mesh/element_parts.hpp"

namespace chladni::mesh {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name)
{
  return std::ranges::find(names, name) != names.end();
}

/// 1 or 2, of the elements of a group; 0 where it has none.
int dimension_of(const ExchangeMesh& mesh, const ExchangeGroup& group)
{
  const auto is_line = [&](std::size_t e) { return mesh.elements[e].shape == Shape::line; };
  const auto n_lines = std::ranges::count_if(group.elements, is_line);
  if (n_lines != 0 && n_lines != std::ssize(group.elements)) {
    throw Error(fmt::format(
        "group \"{}\" holds {} lines and {} surfaces; give each kind a group of its own",
        group.name, n_lines, std::ssize(group.elements) - n_lines));
  }
  if (group.elements.empty()) return 0;
  return n_lines > 0 ? 1 : 2;
}

/// Its name, or NAME_nodes where a group of elements is called so.
std::string name_in_deck(const ExchangeMesh& mesh, const ExchangeGroup& group)
{
  if (!group.elements.empty()) return group.name;
  const auto is_of_elements = [&](const ExchangeGroup& other) {
    return other.name == group.name && !other.elements.empty();
  };
  return std::ranges::any_of(mesh.groups, is_of_elements) ? group.name + "_nodes" : group.name;
}

void add_groups(Deck& deck, const ExchangeMesh& mesh)
{
  for (const ExchangeGroup& group : mesh.groups) {
    DeckGroup added{.name = name_in_deck(mesh, group),
                    .dimension = dimension_of(mesh, group),
                    .nodes = group.nodes};
    if (std::ranges::find(deck.groups, added.name, &DeckGroup::name) != deck.groups.end())
      throw Error(fmt::format("group \"{}\" is there twice; rename one", added.name));
    for (const std::size_t e : group.elements) {
      std::ranges::copy_if(mesh.elements[e].nodes, std::back_inserter(added.nodes),
                           [](std::int64_t node) { return node != 0; });
    }
    deck.groups.push_back(std::move(added));
  }
}

class SectionGroups {
 public:
  SectionGroups(const ExchangeMesh& mesh, const Deck& deck, const MeshOptions& options)
      : mesh_(mesh), deck_(deck), options_(options), group_of_(mesh.elements.size(), -1)
  {}

  /// The group of each element, -1 = none.
  std::vector<int> find()
  {
    for (std::size_t g = 0; g < mesh_.groups.size(); ++g)
      for (const std::size_t e : mesh_.groups[g].elements) take(e, static_cast<int>(g));
    return group_of_;
  }

 private:
  bool has_section(std::size_t element, int group) const
  {
    const bool is_line = mesh_.elements[element].shape == Shape::line;
    return contains(is_line ? options_.line_groups : options_.shell_groups, name(group));
  }

  void take(std::size_t element, int group)
  {
    int& taken = group_of_[element];
    const bool is_of_section = has_section(element, group);
    if (taken >= 0 && taken != group && is_of_section && has_section(element, taken)) {
      throw Error(
          fmt::format("element {} is in the groups \"{}\" and \"{}\", which have a section "
                      "each; take it out of one",
                      mesh_.elements[element].number, name(taken), name(group)));
    }
    if (taken < 0 || (is_of_section && !has_section(element, taken))) taken = group;
  }

  const std::string& name(int group) const
  {
    return deck_.groups[static_cast<std::size_t>(group)].name;
  }

  const ExchangeMesh& mesh_;
  const Deck& deck_;
  const MeshOptions& options_;
  std::vector<int> group_of_;
};

/// The group of surfaces that are in none: one for all of them where no surface is in a group.
/// @return its index, or -1
int group_of_the_rest(Deck& deck)
{
  const auto is_of_surfaces = [](const DeckGroup& group) { return group.dimension == 2; };
  if (std::ranges::any_of(deck.groups, is_of_surfaces)) return -1;
  std::string name = "surfaces";
  while (std::ranges::find(deck.groups, name, &DeckGroup::name) != deck.groups.end()) name += "_";
  return group_index(deck, name, 2);
}

}  // namespace

const char* const solids_are_not_read =
    "a solid element; Chladni has shells and beams: mesh the mid-surface with triangles and "
    "quadrilaterals, or reduce the solids in the program that they come from";

DeckElement exchange_element(std::int64_t number, Shape shape, int order,
                             const std::vector<std::int64_t>& nodes)
{
  const std::vector<int> places = corners_first(shape, order);
  const bool lacks_inner_nodes = shape == Shape::quadrilateral && order > 1 &&
                                 nodes.size() == 4 * static_cast<std::size_t>(order);
  if (nodes.size() != places.size() && !lacks_inner_nodes) {
    throw Error(fmt::format("element {} has {} nodes; {} of order {} has {}", number, nodes.size(),
                            shape == Shape::line       ? "a line"
                            : shape == Shape::triangle ? "a triangle"
                                                       : "a quadrilateral",
                            order, places.size()));
  }
  DeckElement element{.number = number,
                      .shape = shape,
                      .order = order,
                      .nodes = std::vector<std::int64_t>(places.size(), 0),
                      .group = -1};
  for (std::size_t k = 0; k < nodes.size(); ++k)
    element.nodes[static_cast<std::size_t>(places[k])] = nodes[k];
  return element;
}

ExchangeGroup& exchange_group(ExchangeMesh& mesh, const std::string& name, Members members)
{
  const auto is_it = [&](const ExchangeGroup& group) {
    return group.name == name && group.elements.empty() == (members == Members::nodes);
  };
  const auto found = std::ranges::find_if(mesh.groups, is_it);
  if (found != mesh.groups.end()) return *found;
  mesh.groups.push_back({.name = name});
  return mesh.groups.back();
}

Deck deck_of(const ExchangeMesh& mesh, const MeshOptions& options)
{
  Deck deck{.nodes = mesh.nodes, .elements = {}, .groups = {}, .notes = mesh.notes};
  add_groups(deck, mesh);
  const std::vector<int> group_of = SectionGroups(mesh, deck, options).find();
  const int rest = group_of_the_rest(deck);
  int n_left_out = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    DeckElement element = mesh.elements[e];
    const bool is_line = element.shape == Shape::line;
    element.group = group_of[e] < 0 && !is_line ? rest : group_of[e];
    if (is_line && element.group < 0)
      ++n_left_out;
    else
      deck.elements.push_back(std::move(element));
  }
  if (n_left_out > 0)
    deck.notes.push_back(fmt::format("{} lines of no group are left out", n_left_out));
  return deck;
}

}  // namespace chladni::mesh
