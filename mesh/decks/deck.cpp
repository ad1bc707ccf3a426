#include "mesh/decks/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/mesh_repair.hpp"

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
    if (number != 0 && found == index.end()) {
      throw Error(fmt::format("{}element {}: its node {} is not there",
                              element.place.empty() ? "" : element.place + ": ", element.number,
                              number));
    }
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

/// An element for messages: "17 (line 43)".
std::string element_name(const Deck& deck, Shape shape, std::int64_t number)
{
  const auto is_it = [&](const DeckElement& element) {
    return element.number == number && element.shape == shape;
  };
  const auto element = std::ranges::find_if(deck.elements, is_it);
  const bool is_placed = element != deck.elements.end() && !element->place.empty();
  return is_placed ? fmt::format("{} ({})", number, element->place) : fmt::format("{}", number);
}

void refuse_doubled_elements(const Mesh& mesh, const Deck& deck)
{
  for (const ElementBlock& block : mesh.blocks) {
    const std::vector<std::array<int, 2>> pairs = doubled_elements(block);
    if (pairs.empty()) continue;
    const auto name = [&](int e) {
      return element_name(deck, block.shape, block.numbers[std::size_t(e)]);
    };
    throw Error(fmt::format(
        "elements {} and {} have the same nodes{}; set doubled_elements = \"keep\" in [mesh] if "
        "their stiffness and mass are to add up, or \"merge\" to take the first one alone",
        name(pairs[0][0]), name(pairs[0][1]),
        pairs.size() > 1 ? fmt::format(" ({} pairs)", pairs.size()) : ""));
  }
}

void treat_doubled_elements(Mesh& mesh, const Deck& deck, const MeshOptions& options)
{
  if (options.doubled_elements == Doubled::refuse) refuse_doubled_elements(mesh, deck);
  if (options.doubled_elements == Doubled::merge) merge_doubled_elements(mesh, {});
}

/// The middle nodes of edges by their ends.
class Middles {
 public:
  explicit Middles(Deck& deck) : deck_(deck)
  {
    if (!deck.nodes.empty()) next_ = deck.nodes.rbegin()->first + 1;
    first_ = next_;
    for (const DeckElement& element : deck.elements) {
      for (const auto& [a, middle, b] : edges(element)) {
        if (element.order == 1) straight_.emplace(ends(a, b), element.number);
        if (element.order == 2 && middle != 0) middles_.emplace(ends(a, b), middle);
      }
    }
  }

  void complete(DeckElement& element)
  {
    if (element.order != 2 || element.shape == Shape::line) return;
    for (const std::array<int, 3>& places : edge_places(element)) {
      std::int64_t& middle = element.nodes[std::size_t(places[1])];
      if (middle == 0) middle = middle_of(element, places);
    }
  }

  /// An added node is in the sets that have both ends of its edge: it is held where they are.
  void join_sets()
  {
    for (DeckGroup& group : deck_.groups) {
      const std::set<std::int64_t> members(group.nodes.begin(), group.nodes.end());
      for (const auto& [node, ends] : added_)
        if (members.contains(ends.first) && members.contains(ends.second))
          group.nodes.push_back(node);
    }
  }

  std::int64_t n_added() const { return next_ - first_; }
  std::int64_t first() const { return first_; }

 private:
  using Ends = std::pair<std::int64_t, std::int64_t>;
  static Ends ends(std::int64_t a, std::int64_t b) { return std::minmax({a, b}); }
  struct Added {
    std::int64_t node;
    Ends ends;
  };

  /// Places of the nodes of each edge in the lattice, middle ones between the ends.
  static std::vector<std::array<int, 3>> edge_places(const DeckElement& element)
  {
    if (element.shape == Shape::quadrilateral) {
      if (element.order == 1) return {{0, 0, 1}, {1, 1, 3}, {3, 3, 2}, {2, 2, 0}};
      return {{0, 1, 2}, {2, 5, 8}, {8, 7, 6}, {6, 3, 0}};
    }
    if (element.order == 1) return {{0, 0, 1}, {1, 1, 2}, {2, 2, 0}};
    return {{0, 1, 2}, {2, 4, 5}, {5, 3, 0}};
  }

  static std::vector<std::array<std::int64_t, 3>> edges(const DeckElement& element)
  {
    std::vector<std::array<std::int64_t, 3>> found;
    if (element.shape == Shape::line || element.order > 2) return found;
    for (const auto& [a, middle, b] : edge_places(element)) {
      found.push_back({element.nodes[std::size_t(a)], element.nodes[std::size_t(middle)],
                       element.nodes[std::size_t(b)]});
    }
    return found;
  }

  std::int64_t middle_of(const DeckElement& element, const std::array<int, 3>& places)
  {
    const std::int64_t a = element.nodes[std::size_t(places[0])],
                       b = element.nodes[std::size_t(places[2])];
    if (const auto other = straight_.find(ends(a, b)); other != straight_.end()) {
      throw Error(fmt::format(
          "{}: element {} has no node between {} and {}, where element {} of order 1 begins: an "
          "edge has one order here; give all elements the same",
          element.place, element.number, a, b, other->second));
    }
    const auto known = middles_.find(ends(a, b));
    if (known != middles_.end()) return known->second;
    const auto from = deck_.nodes.find(a), to = deck_.nodes.find(b);
    if (from == deck_.nodes.end() || to == deck_.nodes.end()) return 0;  // `mesh_of` names it
    std::array<double, 3> x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = 0.5 * (from->second[c] + to->second[c]);
    deck_.nodes.emplace(next_, x);
    middles_.emplace(ends(a, b), next_);
    added_.push_back({.node = next_, .ends = ends(a, b)});
    return next_++;
  }

  Deck& deck_;
  std::map<Ends, std::int64_t> middles_, straight_;
  std::vector<Added> added_;
  std::int64_t next_ = 1, first_ = 1;
};

/// Whether all nodes of a set are reference nodes, which are no nodes of the mesh.
bool is_of_references(const Deck& deck, const DeckGroup& group)
{
  const auto is_reference = [&](std::int64_t node) {
    return std::ranges::find(deck.couplings, node, &DeckCoupling::reference) !=
           deck.couplings.end();
  };
  return !group.nodes.empty() && std::ranges::all_of(group.nodes, is_reference);
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

void add_missing_middles(Deck& deck)
{
  const auto lacks_middles = [](const DeckElement& element) {
    const auto n = std::ranges::count(element.nodes, 0);
    return element.order == 2 && n > (element.shape == Shape::quadrilateral ? 1 : 0);
  };
  if (std::ranges::none_of(deck.elements, lacks_middles)) return;
  Middles middles(deck);
  for (DeckElement& element : deck.elements) middles.complete(element);
  if (middles.n_added() == 0) return;
  middles.join_sets();
  deck.notes.push_back(fmt::format(
      "{} middle nodes that the deck leaves out stand on straight edges, numbered from {}; they "
      "are in the sets that have both ends of their edge",
      middles.n_added(), middles.first()));
}

Mesh mesh_of(const Deck& deck, const MeshOptions& options)
{
  Mesh mesh;
  const NodeIndex index = add_nodes(mesh, deck);
  for (const DeckGroup& group : deck.groups)
    mesh.groups.push_back({.name = group.name, .dimension = group.dimension, .nodes = {}});
  add_elements(mesh, deck, index, options.line_groups);
  add_groups_of_nodes(mesh, deck, index);
  if (mesh.blocks.empty()) {
    throw Error(
        "it has neither shell elements nor beams of the group of a beam section; see "
        "docs/how-to/meshes.md for what can be read");
  }
  mesh.notes.insert(mesh.notes.begin(), deck.notes.begin(), deck.notes.end());
  treat_doubled_elements(mesh, deck, options);
  add_inner_nodes(mesh);
  drop_unused_nodes(mesh, options.coupled_groups);
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (!mesh.groups[g].nodes.empty() || is_of_references(deck, deck.groups[g])) continue;
    mesh.notes.push_back(
        fmt::format("group \"{}\" is left out: no element has a node of it", mesh.groups[g].name));
  }
  return with_flat_corners_split(std::move(mesh));
}

namespace {

std::string name_of_reference(std::int64_t node)
{
  return fmt::format("node_{}", node);
}

std::string name_of_leader(std::int64_t node)
{
  return fmt::format("leader_{}", node);
}

const std::vector<std::int64_t>& nodes_of(const Deck& deck, const DeckCoupling& coupling)
{
  return std::ranges::find(deck.groups, coupling.group, &DeckGroup::name)->nodes;
}

[[noreturn]] void refuse_coupling(const DeckCoupling& coupling, const std::string& why)
{
  throw Error(fmt::format("{}: {}", coupling.entry, why));
}

/// The place of the reference node in the units of a scene.
std::array<double, 3> place_of(const Deck& deck, const DeckUnits& units,
                               const DeckCoupling& coupling)
{
  const auto node = deck.nodes.find(coupling.reference);
  if (node == deck.nodes.end())
    refuse_coupling(coupling, fmt::format("there is no node {}", coupling.reference));
  std::array<double, 3> x = node->second;
  for (double& c : x) c *= units.length;
  return x;
}

DeclaredCoupling average(const Deck& deck, const DeckUnits& units, const Holders& holders,
                         const DeckCoupling& coupling)
{
  const std::int64_t node = coupling.reference;
  if (holders.is_in_mesh(node)) {
    refuse_coupling(coupling,
                    fmt::format("its reference node {} belongs to an element or follows another "
                                "node; the mean of a scene moves a node of its own",
                                node));
  }
  if (holders.is_reference(node))
    refuse_coupling(coupling, fmt::format("its reference node {} is that of another mean", node));
  for (const std::int64_t averaged : nodes_of(deck, coupling))
    if (!holders.is_in_mesh(averaged))
      refuse_coupling(coupling, fmt::format("its node {} belongs to no element", averaged));
  return {.name = name_of_reference(node),
          .group = coupling.group,
          .kind = CouplingOfDeck::averaging,
          .at = place_of(deck, units, coupling)};
}

DeclaredCoupling rigid(const Deck& deck, const DeckUnits& units, const Holders& holders,
                       const DeckCoupling& coupling)
{
  const std::int64_t node = coupling.reference;
  const std::array<double, 3> place = place_of(deck, units, coupling);
  if (holders.is_in_mesh(node) || holders.is_reference(node)) {
    return {.group = coupling.group,
            .kind = CouplingOfDeck::rigid,
            .to = holders.is_in_mesh(node) ? name_of_leader(node) : name_of_reference(node)};
  }
  return {.name = name_of_reference(node),
          .group = coupling.group,
          .kind = CouplingOfDeck::rigid,
          .at = place};
}

}  // namespace

Holders::Holders(const Deck& deck)
{
  for (const DeckElement& element : deck.elements)
    connected_.insert(element.nodes.begin(), element.nodes.end());
  for (const DeckCoupling& coupling : deck.couplings)
    if (!coupling.averages)
      followers_.insert(nodes_of(deck, coupling).begin(), nodes_of(deck, coupling).end());
}

std::vector<std::int64_t> supported_nodes(const Holders& holders, const std::string& entry,
                                          const std::vector<std::int64_t>& nodes, Declarations& all)
{
  std::vector<std::int64_t> supported, others;
  for (const std::int64_t node : nodes)
    (holders.is_in_mesh(node) || holders.is_reference(node) ? supported : others).push_back(node);
  if (!others.empty()) {
    all.notes.push_back(fmt::format(
        "{}: {} nodes that belong to no element and no coupling, as node {}, are passed "
        "over",
        entry, others.size(), others.front()));
  }
  return supported;
}

void add_leaders(Deck& deck)
{
  const Holders holders(deck);
  for (const DeckCoupling& coupling : deck.couplings) {
    if (coupling.averages || !holders.is_in_mesh(coupling.reference)) continue;
    const int group = group_index(deck, name_of_leader(coupling.reference), 0);
    deck.groups[std::size_t(group)].nodes = {coupling.reference};
  }
}

void declare_couplings(const Deck& deck, const DeckUnits& units, Holders& holders,
                       Declarations& all)
{
  // Rigid bodies may hang at the reference node of a mean.
  for (const bool averages : {true, false}) {
    for (const DeckCoupling& coupling : deck.couplings) {
      if (coupling.averages != averages) continue;
      all.couplings.push_back(averages ? average(deck, units, holders, coupling)
                                       : rigid(deck, units, holders, coupling));
      if (!all.couplings.back().name.empty()) holders.add_reference(coupling.reference);
      if (averages) {
        all.notes.push_back(
            fmt::format("{}: in the scene each of the nodes counts as the area that it stands for",
                        coupling.entry));
      }
    }
  }
}

std::set<std::string> Holders::of(const std::string& group,
                                  const std::vector<std::int64_t>& nodes) const
{
  std::set<std::string> names;
  for (const std::int64_t node : nodes) {
    const bool is_reference = references_.contains(node);
    if (!is_reference && !is_in_mesh(node))
      throw Error(fmt::format("its node {} belongs to no element and no coupling", node));
    names.insert(is_reference ? name_of_reference(node) : group);
  }
  return names;
}

void add_support(Declarations& all, const std::string& group, const std::vector<int>& components)
{
  const auto is_same = [&](const DeclaredSupport& other) {
    return other.group == group && other.components == components;
  };
  if (std::ranges::none_of(all.supports, is_same))
    all.supports.push_back({.group = group, .components = components});
}

}  // namespace chladni::mesh
