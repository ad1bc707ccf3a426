#include "mesh/exchange/exchange_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>

#include "common/error.hpp"
#include "mesh/element_types.hpp"
#include "mesh/exchange/med.hpp"
#include "mesh/exchange/unv.hpp"
#include "mesh/gmsh_text.hpp"

namespace chladni::mesh {

namespace {

bool is_among(const std::vector<std::string>& names, const std::string& name)
{
  return std::ranges::find(names, name) != names.end();
}

int dimension_of(const ExchangeMesh& mesh, std::size_t element)
{
  return dimension(mesh.elements[element].shape);
}

/// Elements of one type with the same nodes become one, in the groups of all of them.
void merge_doubled(ExchangeMesh& mesh)
{
  using Key = std::tuple<Shape, int, std::vector<std::int64_t>>;
  std::map<Key, std::size_t> first_of;
  std::vector<std::size_t> place_of(mesh.elements.size());
  std::vector<DeckElement> kept;
  std::vector<std::int64_t> numbers;  // of the first that is doubled, and of its double
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    DeckElement& element = mesh.elements[e];
    std::vector<std::int64_t> nodes = element.nodes;
    std::ranges::sort(nodes);
    const auto [found, is_new] =
        first_of.emplace(Key{element.shape, element.order, std::move(nodes)}, kept.size());
    place_of[e] = found->second;
    if (!is_new && numbers.empty()) numbers = {kept[found->second].number, element.number};
    if (is_new) kept.push_back(std::move(element));
  }
  const std::size_t n_doubled = mesh.elements.size() - kept.size();
  mesh.elements = std::move(kept);
  if (n_doubled == 0) return;
  for (ExchangeGroup& group : mesh.groups) {
    for (std::size_t& e : group.elements) e = place_of[e];
    std::ranges::sort(group.elements);
    group.elements.erase(std::unique(group.elements.begin(), group.elements.end()),
                         group.elements.end());
  }
  mesh.notes.push_back(fmt::format(
      "{} elements have the nodes of another one of their type (the first are {} and {}): they are "
      "one element in several groups",
      n_doubled, numbers[0], numbers[1]));
}

/// Of the elements of a group, which are of one dimension; 0 where it has none.
int dimension_of(const ExchangeMesh& mesh, const ExchangeGroup& group)
{
  return group.elements.empty() ? 0 : dimension_of(mesh, group.elements.front());
}

/// Adds members to the group of their name that holds the same kind, nodes alone included.
void add_to_group(const ExchangeMesh& mesh, std::vector<ExchangeGroup>& groups,
                  ExchangeGroup members)
{
  const auto same = std::ranges::find_if(groups, [&](const ExchangeGroup& group) {
    return group.name == members.name && dimension_of(mesh, group) == dimension_of(mesh, members);
  });
  if (same == groups.end()) return groups.push_back(std::move(members));
  std::ranges::copy(members.nodes, std::back_inserter(same->nodes));
  std::ranges::copy(members.elements, std::back_inserter(same->elements));
}

/// Groups of one name and one kind of members become one. Lines and surfaces that share the name
/// with elements of a higher dimension become the groups NAME_lines and NAME_faces.
void unite_groups(ExchangeMesh& mesh)
{
  constexpr std::array kinds{"nodes", "lines", "surfaces", "solids"};
  constexpr std::array suffixes{"", "_lines", "_faces", ""};
  std::vector<ExchangeGroup> groups;
  std::map<std::string, int> highest;
  for (ExchangeGroup& group : mesh.groups) {
    std::array<ExchangeGroup, 4> by_dimension;
    for (const std::size_t e : group.elements)
      by_dimension[std::size_t(dimension_of(mesh, e))].elements.push_back(e);
    int& most = highest[group.name];
    for (int d = 1; d <= 3; ++d)
      if (!by_dimension[std::size_t(d)].elements.empty()) most = std::max(most, d);
    // Nodes stay with the elements of the highest dimension of their group.
    std::size_t own = 3;
    while (own > 0 && by_dimension[own].elements.empty()) --own;
    by_dimension[own].nodes = std::move(group.nodes);
    for (std::size_t d = 4; d-- > 0;) {
      if (by_dimension[d].elements.empty() && d != own) continue;
      by_dimension[d].name = group.name;
      add_to_group(mesh, groups, std::move(by_dimension[d]));
    }
  }
  for (ExchangeGroup& group : groups) {
    const auto d = std::size_t(dimension_of(mesh, group)), most = std::size_t(highest[group.name]);
    if (d == 0 || d == most) continue;
    mesh.notes.push_back(
        fmt::format("group \"{0}\" holds {1} and {2} {3}, which are the group \"{0}{4}\" here",
                    group.name, kinds[most], group.elements.size(), kinds[d], suffixes[d]));
    group.name += suffixes[d];
  }
  mesh.groups = std::move(groups);
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
    const std::array names{&options_.line_groups, &options_.shell_groups, &options_.solid_groups};
    return is_among(*names.at(std::size_t(dimension_of(mesh_, element)) - 1), name(group));
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

/// The group of surfaces or solids that are in none: one for all of them where none is in a group.
/// @return its index, or -1
int group_of_the_rest(Deck& deck, int dimension)
{
  const auto is_alike = [&](const DeckGroup& group) { return group.dimension == dimension; };
  if (std::ranges::any_of(deck.groups, is_alike)) return -1;
  std::string name = dimension == 2 ? "surfaces" : "volumes";
  while (std::ranges::find(deck.groups, name, &DeckGroup::name) != deck.groups.end()) name += "_";
  return group_index(deck, name, dimension);
}

}  // namespace

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

Deck deck_of(ExchangeMesh mesh, const MeshOptions& options)
{
  merge_doubled(mesh);
  unite_groups(mesh);
  Deck deck{
      .nodes = mesh.nodes, .elements = {}, .groups = {}, .couplings = {}, .notes = mesh.notes};
  add_groups(deck, mesh);
  const std::vector<int> group_of = SectionGroups(mesh, deck, options).find();
  std::array<std::optional<int>, 4> rest;  // by dimension
  int n_left_out = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    DeckElement element = mesh.elements[e];
    const int d = dimension(element.shape);
    element.group = group_of[e];
    if (element.group < 0 && d == 1) {
      ++n_left_out;
      continue;
    }
    std::optional<int>& others = rest[std::size_t(d)];
    if (element.group < 0 && !others) others = group_of_the_rest(deck, d);
    if (element.group < 0) element.group = *others;
    deck.elements.push_back(std::move(element));
  }
  if (n_left_out > 0)
    deck.notes.push_back(fmt::format("{} lines of no group are left out", n_left_out));
  return deck;
}

Mesh mesh_of(ExchangeMesh mesh, const MeshOptions& options)
{
  return mesh_of(deck_of(std::move(mesh), options), options);
}

Mesh exchange_mesh(const MeshOptions& options)
{
  const std::string& file = *options.file;
  try {
    const std::string bytes = read_all(file);
    const MeshSource source = mesh_source(file).value();
    if (source == MeshSource::med) return mesh_of(med_mesh(bytes), options);
    return mesh_of(unv_mesh(bytes, options.length_unit), options);
  } catch (const Error& error) {
    throw Error(fmt::format("mesh file {}: {}", file, error.what()));
  }
}

}  // namespace chladni::mesh
