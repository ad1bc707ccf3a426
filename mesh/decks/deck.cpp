#include "mesh/decks/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/element_types.hpp"
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
    if (number != 0 && found == index.end())
      throw Error(fmt::format("{}: its node {} is not there", name_of(element), number));
    nodes.push_back(number == 0 ? -1 : found->second);
  }
  return nodes;
}

/// Of a surface without its inner node, which our own elements have alone.
void take_corners(DeckElement& element)
{
  if (!is_surface(element.shape) || std::ranges::count(element.nodes, 0) == 0) return;
  const ElementBlock block{.shape = element.shape,
                           .order = element.order,
                           .nodes_per_element = static_cast<int>(element.nodes.size()),
                           .numbers = {},
                           .nodes = {},
                           .group = {}};
  std::vector<std::int64_t> corners;
  for (const int place : corner_places(block)) corners.push_back(element.nodes[std::size_t(place)]);
  if (element.shape == Shape::quadrilateral) std::swap(corners[2], corners[3]);  // by rows
  element.nodes = std::move(corners);
  element.order = 1;
}

void add_element(Mesh& mesh, const DeckElement& element, const std::vector<int>& nodes)
{
  ElementBlock& block = block_of(mesh, element);
  block.numbers.push_back(element.number);
  block.group.push_back(element.group);
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
}

/// What becomes of the elements of a deck.
enum class Content { solids, shells_and_beams };

bool has_name(const std::vector<std::string>& names, const std::string& name)
{
  return std::ranges::find(names, name) != names.end();
}

bool is_wanted(const DeckElement& element, const std::string& group, Content content,
               const MeshOptions& options)
{
  if (element.marks) return false;
  if (element.shape == Shape::line) return has_name(options.line_groups, group);
  const bool is_of_body = is_solid(element.shape) == (content == Content::solids);
  return is_of_body || (is_surface(element.shape) && has_name(options.shell_groups, group));
}

void tell_what_is_left_out(Mesh& mesh, const std::vector<std::array<int, 4>>& n_left_out,
                           Content content)
{
  std::array<int, 4> n{};
  for (std::size_t g = 0; g < n_left_out.size(); ++g) {
    for (std::size_t d = 0; d < n.size(); ++d) n[d] += n_left_out[g][d];
    if (n_left_out[g][1] == 0 || content == Content::solids) continue;
    mesh.notes.push_back(fmt::format(
        "{} line elements of \"{}\" became a set of nodes, since no section of type beam names it",
        n_left_out[g][1], mesh.groups[g].name));
  }
  if (content == Content::solids && n[1] + n[2] > 0) {
    mesh.notes.push_back(fmt::format(
        "{} surface and {} line elements beside the solids are sets of nodes", n[2], n[1]));
  }
  if (n[3] > 0) {
    mesh.notes.push_back(fmt::format(
        "{} solid elements are left out, since no section of type solid names them", n[3]));
  }
}

void add_elements(Mesh& mesh, const Deck& deck, const NodeIndex& index, Content content,
                  const MeshOptions& options)
{
  std::vector<std::array<int, 4>> n_left_out(deck.groups.size() + 1);  // by dimension
  for (const DeckElement& element : deck.elements) {
    const std::vector<int> nodes = nodes_of(element, index);
    const bool has_group = element.group >= 0;
    const auto g = has_group ? std::size_t(element.group) : deck.groups.size();
    if (has_group) {
      std::ranges::copy_if(nodes, std::back_inserter(mesh.groups[g].nodes),
                           [](int node) { return node >= 0; });
    }
    if (is_wanted(element, has_group ? mesh.groups[g].name : "", content, options))
      add_element(mesh, element, nodes);
    else
      ++n_left_out[g][std::size_t(dimension(element.shape))];
  }
  n_left_out.pop_back();
  tell_what_is_left_out(mesh, n_left_out, content);
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

/// Two nodes, the lower first.
using Ends = std::pair<std::int64_t, std::int64_t>;

Ends ends_of(std::int64_t a, std::int64_t b)
{
  return std::minmax({a, b});
}

/// The edges of the skin of the solids; of surfaces none.
std::set<Ends> edges_of_skin(const Deck& deck)
{
  std::map<std::set<std::int64_t>, std::pair<int, std::vector<std::int64_t>>> faces;
  for (const DeckElement& element : deck.elements) {
    if (!is_solid(element.shape)) continue;
    for (const std::vector<int>& places : solid_faces(element.shape, 1)) {
      std::vector<std::int64_t> corners;
      for (const int place : places) corners.push_back(element.nodes[std::size_t(place)]);
      auto& [n, around] = faces[{corners.begin(), corners.end()}];
      ++n;
      around = std::move(corners);
    }
  }
  std::set<Ends> edges;
  for (const auto& [corners, face] : faces) {
    const auto& [n, around] = face;
    for (std::size_t i = 0; n == 1 && i < around.size(); ++i)
      edges.insert(ends_of(around[i], around[(i + 1) % around.size()]));
  }
  return edges;
}

/// The middle nodes of edges by their ends.
class Middles {
 public:
  explicit Middles(Deck& deck) : deck_(deck)
  {
    if (!deck.nodes.empty()) next_ = deck.nodes.rbegin()->first + 1;
    first_ = next_;
    for (const DeckElement& element : deck.elements) {
      if (element.shape == Shape::line || element.order > 2) continue;
      for (const std::vector<int>& places : places_of_edges(element.shape, element.order)) {
        const auto node = [&](std::size_t i) { return element.nodes[std::size_t(places[i])]; };
        const Ends ends = ends_of(node(0), node(places.size() - 1));
        if (element.order == 1) straight_.emplace(ends, element.number);
        if (element.order == 2 && node(1) != 0) middles_.emplace(ends, node(1));
      }
    }
  }

  void complete(DeckElement& element)
  {
    if (element.order != 2) return;
    for (const std::vector<int>& places : places_of_edges(element.shape, 2)) {
      std::int64_t& middle = element.nodes[std::size_t(places[1])];
      if (middle == 0) middle = middle_of(element, places);
    }
  }

  /// An added node is in the sets that have both ends of its edge: it is held where they are. An
  /// edge inside of solids may join nodes of two faces.
  void join_sets()
  {
    const bool has_solids = std::ranges::any_of(
        deck_.elements, [](const DeckElement& element) { return is_solid(element.shape); });
    const std::set<Ends> skin = edges_of_skin(deck_);
    for (DeckGroup& group : deck_.groups) {
      const std::set<std::int64_t> members(group.nodes.begin(), group.nodes.end());
      for (const auto& [node, ends] : added_) {
        if (members.contains(ends.first) && members.contains(ends.second) &&
            (!has_solids || skin.contains(ends)))
          group.nodes.push_back(node);
      }
    }
  }

  std::int64_t n_added() const { return next_ - first_; }
  std::int64_t first() const { return first_; }

 private:
  struct Added {
    std::int64_t node;
    Ends ends;
  };

  std::int64_t middle_of(const DeckElement& element, const std::vector<int>& places)
  {
    const std::int64_t a = element.nodes[std::size_t(places[0])],
                       b = element.nodes[std::size_t(places[2])];
    if (const auto other = straight_.find(ends_of(a, b)); other != straight_.end()) {
      throw Error(
          fmt::format("{} has no node between {} and {}, where element {} of order 1 begins: an "
                      "edge has one order here; give all elements the same",
                      name_of(element), a, b, other->second));
    }
    const auto known = middles_.find(ends_of(a, b));
    if (known != middles_.end()) return known->second;
    const auto from = deck_.nodes.find(a), to = deck_.nodes.find(b);
    if (from == deck_.nodes.end() || to == deck_.nodes.end()) return 0;  // `mesh_of` names it
    std::array<double, 3> x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = 0.5 * (from->second[c] + to->second[c]);
    deck_.nodes.emplace(next_, x);
    middles_.emplace(ends_of(a, b), next_);
    added_.push_back({.node = next_, .ends = ends_of(a, b)});
    deck_.added_middles.push_back({next_, a, b});
    return next_++;
  }

  Deck& deck_;
  std::map<Ends, std::int64_t> middles_, straight_;
  std::vector<Added> added_;
  std::int64_t next_ = 1, first_ = 1;
};

bool lacks_middles(const DeckElement& element)
{
  const auto n = std::ranges::count(element.nodes, 0);
  return element.order == 2 && n > (element.shape == Shape::quadrilateral ? 1 : 0);
}

/// @return the number of nodes that were added, and that of the first one
std::pair<std::int64_t, std::int64_t> completed(Deck& deck)
{
  Middles middles(deck);
  for (DeckElement& element : deck.elements) middles.complete(element);
  if (middles.n_added() > 0) middles.join_sets();
  return {middles.n_added(), middles.first()};
}

/// The same corners, with 0 for the nodes in the middle of edges.
void raise(DeckElement& element)
{
  const auto block = [&](int order) {
    return ElementBlock{.shape = element.shape,
                        .order = order,
                        .nodes_per_element = n_nodes_of(element.shape, order),
                        .numbers = {},
                        .nodes = {},
                        .group = {}};
  };
  const std::vector<int> before = corner_places(block(1)), after = corner_places(block(2));
  std::vector<std::int64_t> nodes(std::size_t(block(2).nodes_per_element), 0);
  for (std::size_t i = 0; i < before.size(); ++i)
    nodes[std::size_t(after[i])] = element.nodes[std::size_t(before[i])];
  element.nodes = std::move(nodes);
  element.order = 2;
}

/// Tetrahedra and wedges with four and six nodes are far too stiff.
void raise_linear_solids(Deck& deck)
{
  const auto is_stiff = [](const DeckElement& element) {
    return element.order == 1 &&
           (element.shape == Shape::tetrahedron || element.shape == Shape::wedge);
  };
  if (std::ranges::none_of(deck.elements, is_stiff)) return;
  for (DeckElement& element : deck.elements)
    if (element.order == 1) raise(element);
  completed(deck);
  deck.notes.emplace_back(solids_are_raised);
}

void check_solid(const Deck& deck, const DeckElement& element)
{
  std::vector<std::int64_t> nodes = element.nodes;
  std::erase(nodes, 0);
  std::ranges::sort(nodes);
  const auto twice = std::ranges::adjacent_find(nodes);
  if (twice != nodes.end()) {
    throw Error(
        fmt::format("{} has the node {} twice; write a collapsed element as the wedge or "
                    "tetrahedron that it is",
                    name_of(element), *twice));
  }
  if (orientation(element, deck.nodes) >= 0.0) return;  // 0: what is flat is named by its quality
  throw Error(
      fmt::format("{} is inside out: seen from the opposite corners, its first {} nodes must go "
                  "round counter-clockwise; list them the other way round",
                  name_of(element), element.shape == Shape::hexahedron ? 4 : 3));
}

/// An edge with a node in its middle beside one without would gape.
void refuse_two_orders(const Deck& deck)
{
  std::map<Ends, const DeckElement*> straight;
  const auto for_edges = [&](int order, const auto& visit) {
    for (const DeckElement& element : deck.elements) {
      if (!is_solid(element.shape) || element.order != order) continue;
      for (const std::vector<int>& places : places_of_edges(element.shape, order)) {
        visit(element, ends_of(element.nodes[std::size_t(places.front())],
                               element.nodes[std::size_t(places.back())]));
      }
    }
  };
  for_edges(
      1, [&](const DeckElement& element, const Ends& ends) { straight.emplace(ends, &element); });
  if (straight.empty()) return;
  for_edges(2, [&](const DeckElement& element, const Ends& ends) {
    const auto other = straight.find(ends);
    if (other == straight.end()) return;
    throw Error(
        fmt::format("{} has a node between {} and {}, and {} has none: an edge has one "
                    "order here; give all elements the same",
                    name_of(element), ends.first, ends.second, name_of(*other->second)));
  });
}

/// Elements that a section of the scene takes by a set of them.
void take_sets(Deck& deck, const MeshOptions& options)
{
  std::unordered_map<std::int64_t, std::size_t> place_of;
  std::unordered_map<std::int64_t, int> taken;
  for (std::size_t g = 0; g < deck.groups.size(); ++g) {
    DeckGroup& group = deck.groups[g];
    const auto is_named = [&](const std::vector<std::string>& names) {
      return has_name(names, group.name);
    };
    if (group.elements.empty() ||
        !(is_named(options.solid_groups) || is_named(options.shell_groups) ||
          is_named(options.line_groups)))
      continue;
    if (place_of.empty())
      for (std::size_t e = 0; e < deck.elements.size(); ++e)
        place_of.emplace(deck.elements[e].number, e);
    for (const std::int64_t number : group.elements) {
      const auto found = place_of.find(number);
      if (found == place_of.end()) continue;
      const auto [other, is_new] = taken.emplace(number, int(g));
      if (!is_new) {
        throw Error(
            fmt::format("element {} is in the sets \"{}\" and \"{}\", which have a section "
                        "each; take it out of one",
                        number, deck.groups[std::size_t(other->second)].name, group.name));
      }
      deck.elements[found->second].group = int(g);
      group.dimension = dimension(deck.elements[found->second].shape);
    }
  }
}

Content content_of(const Deck& deck, const MeshOptions& options)
{
  const bool has_solids = std::ranges::any_of(
      deck.elements, [](const DeckElement& element) { return is_solid(element.shape); });
  if (!options.solid_groups.empty() && !has_solids) {
    throw Error(fmt::format(
        "it has no solid elements, of which the section of \"{}\" is; take type = \"shell\"",
        options.solid_groups.front()));
  }
  const bool is_named = !options.solid_groups.empty() ||
                        (options.shell_groups.empty() && options.line_groups.empty());
  return has_solids && is_named ? Content::solids : Content::shells_and_beams;
}

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

/// A node in the middle of an edge whose ends equations move goes with them, as the edge does in
/// the deck, which has no such node.
void add_equations_of_middles(Deck& deck)
{
  std::map<std::int64_t, std::set<int>> moved;
  for (const DeckEquation& equation : deck.equations)
    for (const DeckEquation::Term& term : equation.terms) moved[term.node].insert(term.component);
  for (const auto& [middle, a, b] : deck.added_middles) {
    const auto of_a = moved.find(a), of_b = moved.find(b);
    if (of_a == moved.end() || of_b == moved.end()) continue;
    for (const int c : of_a->second) {
      if (!of_b->second.contains(c) || moved[middle].contains(c)) continue;
      deck.equations.push_back({.entry = fmt::format("node between the nodes {} and {}", a, b),
                                .terms = {{middle, c, -1.0}, {a, c, 0.5}, {b, c, 0.5}}});
    }
  }
}

/// A support in own axes of a node that equations alone move would hold nothing.
void refuse_held_apart(const Deck& deck)
{
  for (const auto& [node, entry] : deck.held_apart)
    for (const DeckEquation& equation : deck.equations)
      if (std::ranges::find(equation.terms, node, &DeckEquation::Term::node) !=
          equation.terms.end()) {
        throw Error(
            fmt::format("{}: node {} belongs to no element and has axes of its own; hold "
                        "it in the basic axes",
                        entry, node));
      }
}

void add_equations(Mesh& mesh, Deck& deck, const NodeIndex& index)
{
  refuse_held_apart(deck);
  const std::size_t n_of_deck = deck.equations.size();
  add_equations_of_middles(deck);
  for (const DeckEquation& equation : deck.equations) {
    mesh.equations.push_back({.place = equation.entry, .terms = {}});
    for (const auto& [number, component, factor] : equation.terms) {
      const auto node = index.find(number);
      if (node == index.end())
        throw Error(fmt::format("{}: there is no node {}", equation.entry, number));
      mesh.equations.back().terms.push_back({node->second, component, factor});
    }
  }
  if (!deck.equations.empty()) {
    mesh.notes.push_back(fmt::format(
        "{} equations between nodes hold as the deck has them, supports in own axes of nodes among "
        "them, in every analysis and in a reduced body",
        n_of_deck));
  }
}

/// Equations of the nodes of a tie with the faces of solids at which they stand.
class Tying {
 public:
  Tying(Mesh& mesh, const DeckTie& tie) : mesh_(mesh), tie_(tie)
  {
    const std::set<int> members = nodes_of(tie.faces);
    for (const FreeFace& face : free_faces(mesh))
      if (std::ranges::all_of(face.nodes, [&](int node) { return members.contains(node); }))
        faces_.push_back(face);
    if (faces_.empty())
      refuse(fmt::format("\"{}\" holds no face of solids to which nodes could be tied", tie.faces));
    for (const ElementBlock& block : mesh.blocks)
      if (!is_solid(block.shape)) rotating_.insert(block.nodes.begin(), block.nodes.end());
  }

  void add_equations()
  {
    std::set<int> of_faces;
    for (const FreeFace& face : faces_) of_faces.insert(face.nodes.begin(), face.nodes.end());
    int n_tied = 0, n_free = 0;
    double widest = 0.0;
    for (const int node : nodes_of(tie_.nodes)) {
      if (of_faces.contains(node)) continue;
      if (rotating_.contains(node)) {
        refuse(fmt::format("node {} of a shell or beam would hang at the faces as at hinges",
                           mesh_.node_numbers[std::size_t(node)]));
      }
      const Nearest at = nearest(node);
      const bool is_tied = at.gap <= tie_.gap.value_or(of_size * size(*at.face));
      ++(is_tied ? n_tied : n_free);
      if (!is_tied) continue;
      widest = std::max(widest, at.gap);
      if (!tie_.moves && at.gap > touching * size(*at.face)) {
        refuse(
            fmt::format("ADJUST = NO leaves node {} apart from the face that it follows; let it "
                        "be moved there, or mesh it there",
                        mesh_.node_numbers[std::size_t(node)]));
      }
      follow(node, at);
    }
    if (n_tied == 0) refuse("none of its nodes is near its faces");
    mesh_.notes.push_back(fmt::format(
        "{}: {} nodes move as the faces do at which they stand{}{}", tie_.entry, n_tied,
        widest > 0.0
            ? fmt::format(", onto which they were moved by up to {:.2g} of the deck's lengths",
                          widest)
            : "",
        n_free > 0 ? fmt::format("; {} are too far away and stay free", n_free) : ""));
  }

 private:
  static constexpr double of_size = 0.05, touching = 1e-4;  // of the size of a face

  struct Nearest {
    const FreeFace* face;
    std::vector<double> N;
    Vector x;
    double gap;
  };

  [[noreturn]] void refuse(const std::string& why) const
  {
    throw Error(fmt::format("{}: {}", tie_.entry, why));
  }

  std::set<int> nodes_of(const std::string& group) const
  {
    const std::vector<int>& nodes = find_group(mesh_, group).nodes;
    return {nodes.begin(), nodes.end()};
  }

  const Vector& position(int node) const { return mesh_.positions[std::size_t(node)]; }
  int order(const FreeFace& face) const { return mesh_.blocks[face.block].order; }
  /// Of its edges in the mean.
  double size(const FreeFace& face) const
  {
    const std::size_t n = face.nodes.size() / std::size_t(order(face));
    double around = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      around += norm(minus(position(face.nodes[(i + 1) % n]), position(face.nodes[i])));
    return around / double(n);
  }

  Nearest at(const FreeFace& face, double r, double s, const Vector& x) const
  {
    Nearest here{&face, face_functions(face.nodes.size(), order(face), r, s), {}, 0.0};
    for (std::size_t i = 0; i < here.N.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) here.x[c] += here.N[i] * position(face.nodes[i])[c];
    here.gap = norm(minus(x, here.x));
    return here;
  }

  /// By Gauss and Newton in the parent coordinates, which stay in the face.
  Nearest nearest(const FreeFace& face, const Vector& x) const
  {
    constexpr int most_steps = 30;
    constexpr double step = 1e-4, converged = 1e-12;
    const bool is_triangle = std::ssize(face.nodes) == 3 * order(face);
    double r = is_triangle ? 1.0 / 3.0 : 0.0, s = r;
    for (int i = 0; i < most_steps; ++i) {
      const auto slope = [&](double dr, double ds) {
        Vector by = minus(at(face, r + dr, s + ds, x).x, at(face, r - dr, s - ds, x).x);
        for (double& c : by) c /= 2.0 * step;
        return by;
      };
      const Vector a = slope(step, 0.0), b = slope(0.0, step), d = minus(x, at(face, r, s, x).x);
      const double det = dot(a, a) * dot(b, b) - dot(a, b) * dot(a, b);
      if (!(det > 0.0)) break;
      const double r_0 = r, s_0 = s;
      r += (dot(a, d) * dot(b, b) - dot(b, d) * dot(a, b)) / det;
      s += (dot(b, d) * dot(a, a) - dot(a, d) * dot(a, b)) / det;
      if (is_triangle) {
        r = std::clamp(r, 0.0, 1.0);
        s = std::clamp(s, 0.0, 1.0 - r);
      } else {
        r = std::clamp(r, -1.0, 1.0);
        s = std::clamp(s, -1.0, 1.0);
      }
      if (std::abs(r - r_0) + std::abs(s - s_0) < converged) break;
    }
    return at(face, r, s, x);
  }

  Nearest nearest(int node) const
  {
    Nearest best{nullptr, {}, {}, std::numeric_limits<double>::infinity()};
    for (const FreeFace& face : faces_) {
      double reach = 0.0, distance = std::numeric_limits<double>::infinity();
      for (const int corner : face.nodes) {
        reach = std::max(reach, norm(minus(position(corner), position(face.nodes[0]))));
        distance = std::min(distance, norm(minus(position(corner), position(node))));
      }
      if (distance > 2.0 * reach + tie_.gap.value_or(0.0) && best.face != nullptr) continue;
      Nearest found = nearest(face, position(node));
      if (found.gap < best.gap) best = std::move(found);
    }
    return best;
  }

  void follow(int node, const Nearest& at)
  {
    constexpr double none = 1e-11;  // of a node across the edge at which the point lies
    if (at.gap > 0.0) mesh_.positions[std::size_t(node)] = at.x;
    for (int c = 0; c < 3; ++c) {
      Equation equation{.place = tie_.entry, .terms = {{node, c, -1.0}}};
      for (std::size_t i = 0; i < at.N.size(); ++i)
        if (std::abs(at.N[i]) > none) equation.terms.push_back({at.face->nodes[i], c, at.N[i]});
      mesh_.equations.push_back(std::move(equation));
    }
  }

  Mesh& mesh_;
  const DeckTie& tie_;
  std::vector<FreeFace> faces_;
  std::set<int> rotating_;
};

}  // namespace

int group_index(Deck& deck, const std::string& name, int dimension)
{
  const auto found = std::ranges::find(deck.groups, name, &DeckGroup::name);
  if (found != deck.groups.end()) return static_cast<int>(found - deck.groups.begin());
  deck.groups.push_back({.name = name, .dimension = dimension, .nodes = {}});
  return static_cast<int>(deck.groups.size()) - 1;
}

std::string name_of(const DeckElement& element)
{
  return fmt::format("{}element {}", element.place.empty() ? "" : element.place + ": ",
                     element.number);
}

double orientation(const DeckElement& element,
                   const std::map<std::int64_t, std::array<double, 3>>& nodes)
{
  if (!is_solid(element.shape)) return 0.0;
  // Opposite ends of the parent axes, between which the tangents at the centre are means.
  std::vector<Vector> x;
  for (int i = 0; i < n_corners(element.shape); ++i) {
    const auto found = nodes.find(element.nodes[std::size_t(i)]);
    if (found == nodes.end()) return 0.0;
    x.push_back(found->second);
  }
  std::array<Vector, 3> tangents{};
  const auto add = [&](std::size_t axis, std::size_t from, std::size_t to) {
    for (std::size_t c = 0; c < 3; ++c) tangents[axis][c] += x[to][c] - x[from][c];
  };
  const std::size_t above = x.size() == 4 ? 3 : x.size() / 2;
  const bool is_hexahedron = element.shape == Shape::hexahedron;
  for (std::size_t bottom = 0; bottom + above <= x.size(); bottom += above) {
    add(0, bottom, bottom + 1);
    add(1, bottom, bottom + (is_hexahedron ? 3 : 2));
    if (!is_hexahedron) continue;
    add(0, bottom + 3, bottom + 2);
    add(1, bottom + 1, bottom + 2);
  }
  for (std::size_t i = 0; i + above < x.size(); ++i) add(2, i, i + above);
  return dot(cross(tangents[0], tangents[1]), tangents[2]);
}

bool are_whole(const std::vector<int>& components)
{
  const auto n = std::ranges::count_if(components, [](int c) { return c < 3; });
  return n % 3 == 0 && (std::ssize(components) - n) % 3 == 0;
}

void add_term(const Deck& deck, DeckEquation& equation, const DeckEquation::Term& term)
{
  const auto axes = deck.axes.find(term.node);
  if (axes == deck.axes.end()) return equation.terms.push_back(term);
  const Vector& axis = axes->second[std::size_t(term.component % 3)];
  for (int c = 0; c < 3; ++c)
    if (const double part = axis[std::size_t(c)]; part != 0.0)
      equation.terms.push_back({term.node, term.component / 3 * 3 + c, term.factor * part});
}

NodesOfDeck::NodesOfDeck(const Deck& deck)
{
  for (const DeckElement& element : deck.elements) {
    if (element.marks) continue;
    connected.insert(element.nodes.begin(), element.nodes.end());
    if (!is_solid(element.shape)) rotating.insert(element.nodes.begin(), element.nodes.end());
  }
}

void hold_in_axes(Deck& deck, const NodesOfDeck& known, const DeckSupport& support)
{
  if (are_whole(support.components)) return;
  for (const std::int64_t node : support.nodes) {
    if (!deck.axes.contains(node)) continue;
    if (!known.connected.contains(node)) {
      deck.held_apart.emplace_back(node, support.entry);
      continue;
    }
    for (const int c : support.components) {
      if (c >= 3 && !known.rotating.contains(node)) continue;
      DeckEquation equation{.entry = support.entry, .terms = {}};
      add_term(deck, equation, {node, c, 1.0});
      deck.equations.push_back(std::move(equation));
    }
  }
}

std::vector<std::int64_t> held_in_basic_axes(const Deck& deck,
                                             const std::vector<std::int64_t>& nodes,
                                             const std::vector<int>& components)
{
  std::vector<std::int64_t> others = nodes;
  if (!are_whole(components))
    std::erase_if(others, [&](std::int64_t node) { return deck.axes.contains(node); });
  return others;
}

namespace {

Vector position_of(const Deck& deck, const std::string& entry, std::int64_t node)
{
  const auto found = deck.nodes.find(node);
  if (found == deck.nodes.end()) throw Error(fmt::format("{}: there is no node {}", entry, node));
  return found->second;
}

/// The axis of a component of a node.
Vector axis_of(const Deck& deck, std::int64_t node, int component)
{
  const auto axes = deck.axes.find(node);
  if (axes != deck.axes.end()) return axes->second[std::size_t(component % 3)];
  Vector axis{};
  axis[std::size_t(component % 3)] = 1.0;
  return axis;
}

/// Adds factor a . u (first = 0) or factor a . theta (first = 3) of a node.
void add_along(DeckEquation& equation, std::int64_t node, int first, const Vector& a, double factor)
{
  for (int c = 0; c < 3; ++c)
    if (const double part = factor * a[std::size_t(c)]; part != 0.0)
      equation.terms.push_back({node, first + c, part});
}

/// The inverse of a symmetric matrix, by cofactors.
DeckAxes inverse(const DeckAxes& A, const std::string& entry)
{
  DeckAxes B{cross(A[1], A[2]), cross(A[2], A[0]), cross(A[0], A[1])};
  const double det = dot(A[0], B[0]), trace = A[0][0] + A[1][1] + A[2][2];
  if (!(det > 1e-9 * trace * trace * trace))
    throw Error(fmt::format("{}: its nodes lie on one line or are too few", entry));
  for (Vector& row : B)
    for (double& b : row) b /= det;
  return B;
}

}  // namespace

void add_rigid_equations(Deck& deck, const std::string& entry, std::int64_t reference,
                         std::int64_t node, const std::vector<int>& components)
{
  const Vector arm = minus(position_of(deck, entry, node), position_of(deck, entry, reference));
  for (const int component : components) {
    const Vector a = axis_of(deck, node, component);
    DeckEquation equation{.entry = entry, .terms = {}};
    const int first = component / 3 * 3;
    add_along(equation, node, first, a, -1.0);
    add_along(equation, reference, first, a, 1.0);
    if (first == 0) add_along(equation, reference, 3, cross(arm, a), 1.0);  // (theta x arm) . a
    deck.equations.push_back(std::move(equation));
  }
}

void add_elongation(Deck& deck, const NodesOfDeck& known, const DeckElongation& elongation)
{
  const auto& [entry, group, nodes] = elongation;
  const Vector a = position_of(deck, entry, nodes[0]), b = position_of(deck, entry, nodes[1]);
  const Vector along = minus(b, a);
  if (!(norm(along) > 0.0)) throw Error(fmt::format("{}: its nodes are at one place", entry));
  const std::int64_t added = deck.nodes.rbegin()->first + 1;
  Vector middle{};
  for (std::size_t c = 0; c < 3; ++c) middle[c] = 0.5 * (a[c] + b[c]);
  deck.nodes[added] = middle;
  deck.groups[std::size_t(group_index(deck, group, 0))].nodes = {added};
  const bool turn = known.turns(nodes[0]) && known.turns(nodes[1]);
  for (const int first : turn ? std::vector{0, 3} : std::vector{0}) {
    DeckEquation equation{.entry = entry, .terms = {{added, first, -1.0}}};
    add_along(equation, nodes[1], first, unit(along), 1.0);
    add_along(equation, nodes[0], first, unit(along), -1.0);
    deck.equations.push_back(std::move(equation));
  }
}

void add_mean_equations(Deck& deck, const std::string& entry, std::int64_t reference,
                        const std::vector<int>& components,
                        const std::map<std::int64_t, double>& weights)
{
  double sum = 0.0;
  Vector centre{};
  for (const auto& [node, weight] : weights) {
    const Vector x = position_of(deck, entry, node);
    sum += weight;
    for (std::size_t c = 0; c < 3; ++c) centre[c] += weight * x[c];
  }
  for (double& c : centre) c /= sum;
  DeckAxes J{};  // sum w (r^2 I - r r^T)
  for (const auto& [node, weight] : weights) {
    const Vector r = minus(position_of(deck, entry, node), centre);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        J[i][k] += weight / sum * ((i == k ? dot(r, r) : 0.0) - r[i] * r[k]);
  }
  const DeckAxes J_inverse = inverse(J, entry);
  const Vector arm = minus(position_of(deck, entry, reference), centre);
  for (const int component : components) {
    const Vector a = axis_of(deck, reference, component);
    DeckEquation equation{.entry = entry, .terms = {}};
    add_along(equation, reference, component / 3 * 3, a, -1.0);
    // a . theta_ref, or a . (theta_ref x arm) = theta_ref . (arm x a), theta_ref = J^-1 sum w r x u
    const Vector b = component < 3 ? cross(arm, a) : a;
    Vector turn{};
    for (std::size_t i = 0; i < 3; ++i) turn[i] = dot(J_inverse[i], b);
    for (const auto& [node, weight] : weights) {
      Vector of_node = cross(turn, minus(position_of(deck, entry, node), centre));
      for (std::size_t c = 0; c < 3 && component < 3; ++c) of_node[c] += a[c];
      add_along(equation, node, 0, of_node, weight / sum);
    }
    deck.equations.push_back(std::move(equation));
  }
}

bool have_rotations(const Deck& deck, const std::vector<std::int64_t>& nodes)
{
  const std::set<std::int64_t> all(nodes.begin(), nodes.end());
  return std::ranges::any_of(deck.elements, [&](const DeckElement& element) {
    return !is_solid(element.shape) && !element.marks &&
           std::ranges::any_of(element.nodes,
                               [&](std::int64_t node) { return all.contains(node); });
  });
}

void add_missing_middles(Deck& deck)
{
  if (std::ranges::none_of(deck.elements, lacks_middles)) return;
  const auto [n, first] = completed(deck);
  if (n == 0) return;
  deck.notes.push_back(fmt::format(
      "{} middle nodes that the deck leaves out stand on straight edges, numbered from {}; they "
      "are in the sets that have both ends of their edge",
      n, first));
}

Mesh mesh_of(Deck deck, const MeshOptions& options)
{
  take_sets(deck, options);
  const Content content = content_of(deck, options);
  if (content == Content::solids) {
    for (const DeckElement& element : deck.elements)
      if (is_solid(element.shape)) check_solid(deck, element);
    if (!options.matrices) raise_linear_solids(deck);
    if (!options.matrices) refuse_two_orders(deck);
  }
  Mesh mesh;
  const NodeIndex index = add_nodes(mesh, deck);
  if (options.matrices) std::ranges::for_each(deck.elements, take_corners);
  for (const DeckGroup& group : deck.groups) {
    mesh.groups.push_back(
        {.name = group.name, .dimension = group.is_of_faces ? 2 : group.dimension, .nodes = {}});
  }
  add_elements(mesh, deck, index, content, options);
  add_groups_of_nodes(mesh, deck, index);
  if (!options.matrices) {  // which have them already
    add_equations(mesh, deck, index);
    for (const DeckTie& tie : deck.ties) Tying(mesh, tie).add_equations();
  }
  if (mesh.blocks.empty() && !options.matrices) {
    throw Error(
        "it has neither solids nor shells, nor beams of the group of a beam section; see "
        "docs/how-to/meshes.md for what can be read");
  }
  mesh.notes.insert(mesh.notes.begin(), deck.notes.begin(), deck.notes.end());
  if (options.matrices) return mesh;  // its nodes are those of the matrices
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
  for (const DeckEquation& equation : deck.equations)
    for (const DeckEquation::Term& term : equation.terms) connected_.insert(term.node);
  for (const DeckCoupling& coupling : deck.couplings)
    if (!coupling.averages)
      followers_.insert(nodes_of(deck, coupling).begin(), nodes_of(deck, coupling).end());
}

std::vector<std::int64_t> Holders::held_in_basic_axes(const Deck& deck,
                                                      const std::vector<std::int64_t>& nodes,
                                                      const std::vector<int>& components) const
{
  for (const std::int64_t node : nodes) {
    if (!deck.axes.contains(node) || !is_reference(node) || are_whole(components)) continue;
    throw Error(fmt::format(
        "node {} is the reference node of a coupling, and is held in the basic axes alone", node));
  }
  return mesh::held_in_basic_axes(deck, nodes, components);
}

bool Declarations::has_section(const std::string& group) const
{
  const auto is_of_it = [&](const auto& section) { return section.group == group; };
  return std::ranges::any_of(shells, is_of_it) || std::ranges::any_of(beams, is_of_it) ||
         std::ranges::any_of(solids, is_of_it);
}

void Declarations::add(const DeclaredMaterial& material, const std::string& place)
{
  materials.push_back(material);
  if (material.density > 0.0) return;
  notes.push_back(
      fmt::format("{}: the material has no density and therefore no mass, as static loads need "
                  "none; natural frequencies do: write it into material.{}",
                  place, material.name));
}

bool Declarations::uses(const std::string& material) const
{
  const auto is_of_it = [&](const auto& section) { return section.material == material; };
  return std::ranges::any_of(shells, is_of_it) || std::ranges::any_of(beams, is_of_it) ||
         std::ranges::any_of(solids, is_of_it);
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
