// One table for all formats: a row for each kind of element, a column for each format.

#include "mesh/decks/file_elements.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "mesh/decks/deck_text.hpp"
#include "mesh/element_types.hpp"

namespace chladni::mesh {

namespace {

/// The order in which a format lists the nodes of an element.
enum class NodeOrder {
  edges_last,     ///< corners, then the edges of the bottom, of the top, and those between
  upright_edges,  ///< corners, then the edges of the bottom, those between, and of the top
  around          ///< bottom with the middles between the corners, then those between, then the top
};

struct FormatRule {
  Format format;
  NodeOrder solids, surfaces, lines;
};

using enum NodeOrder;

constexpr std::array<FormatRule, 5> rules{{{Format::nastran, upright_edges, edges_last, edges_last},
                                           {Format::abaqus, edges_last, edges_last, around},
                                           {Format::unv, around, around, around},
                                           {Format::med, edges_last, edges_last, edges_last},
                                           {Format::ansys, edges_last, edges_last, edges_last}}};

/// A kind of element, and what each format calls it: names between blanks, with ~ before one of
/// reduced integration or mixed form, and # before one that only marks faces or edges.
struct ElementRow {
  Shape shape;
  int order;
  std::size_t n_nodes;  ///< that a file lists
  std::string_view nastran, abaqus, unv, med, ansys;
};

using enum Shape;

// Descriptors of membranes, 71 and 74, are exchanged.
constexpr std::array<ElementRow, 15> rows{{
    {line, 1, 2, "CBAR CBEAM", "B31 ~B31R #T3D2", "11 21 22", "SE2", ""},
    {line, 2, 3, "", "B32 ~B32R #T3D3", "23 24", "SE3", ""},
    {triangle, 1, 3, "CTRIA3", "S3 S3R S3RS #CPS3 #CPE3 #M3D3", "41 51 61 74 91", "TR3", ""},
    {triangle, 2, 6, "CTRIA6", "S6 STRI65 #CPS6 #CPE6 #M3D6", "42 52 62 72 92", "TR6", ""},
    {quadrilateral, 1, 4, "CQUAD4", "S4 S4R S4RS S4R5 #CPS4 #CPE4 #M3D4", "44 54 64 71 94", "QU4",
     "181"},
    {quadrilateral, 2, 8, "CQUAD8", "S8 S8R S8R5 #CPS8 #CPE8 #M3D8", "45 55 65 75 95", "QU8",
     "281"},
    {quadrilateral, 2, 9, "", "", "45 55 65 75 95", "QU9", ""},
    {tetrahedron, 1, 4, "CTETRA", "C3D4 ~C3D4H", "111", "TE4", "285"},
    {tetrahedron, 2, 10, "CTETRA", "C3D10 ~C3D10H ~C3D10M ~C3D10MH ~C3D10T", "118", "T10",
     "187 92"},
    {wedge, 1, 6, "CPENTA", "C3D6 ~C3D6H", "112", "PE6", ""},
    {wedge, 2, 15, "CPENTA", "C3D15 ~C3D15H", "113", "P15", ""},
    {wedge, 2, 18, "", "", "", "P18", ""},
    {hexahedron, 1, 8, "CHEXA", "C3D8 C3D8I ~C3D8R ~C3D8H ~C3D8RH", "115", "HE8", "185 45"},
    {hexahedron, 2, 20, "CHEXA", "C3D20 ~C3D20R ~C3D20H ~C3D20RH", "116", "H20", "186 95"},
    {hexahedron, 2, 27, "", "", "", "H27", ""},
}};

std::string_view names_in(const ElementRow& row, Format format)
{
  const std::array names{row.nastran, row.abaqus, row.unv, row.med, row.ansys};
  return names[std::size_t(format)];
}

struct NamedUse {
  std::string name;
  ElementUse use;
};

std::vector<NamedUse> uses_in(const ElementRow& row, Format format)
{
  std::vector<NamedUse> uses;
  for (const std::string& word : words_of(names_in(row, format))) {
    const bool is_reduced = word.front() == '~', is_marking = word.front() == '#';
    uses.push_back({.name = word.substr(is_reduced || is_marking ? 1 : 0),
                    .use = is_reduced   ? ElementUse::reduced
                           : is_marking ? ElementUse::marking
                                        : ElementUse::full});
  }
  return uses;
}

NodeOrder order_of(Shape shape, Format format)
{
  const FormatRule& rule = *std::ranges::find(rules, format, &FormatRule::format);
  return is_solid(shape) ? rule.solids : is_surface(shape) ? rule.surfaces : rule.lines;
}

/// Adds corners `first` to `first` + n with the middles of the edges between them, which begin at
/// place `middle`.
void add_around(std::vector<int>& places, int first, int n, int middle)
{
  for (int i = 0; i < n; ++i) {
    places.push_back(first + i);
    places.push_back(middle + i);
  }
}

/// Place of each node of a solid of order 2 among corners and the edges in our order.
std::vector<int> solid_places(Shape shape, NodeOrder order)
{
  const bool is_tetrahedron = shape == tetrahedron;
  const int n = n_corners(shape), side = is_tetrahedron ? 3 : n / 2;  // corners of the bottom
  const int top = n + side, upright = is_tetrahedron ? n + side : n + 2 * side;
  std::vector<int> places;
  const auto add = [&](int first, int count) {
    for (int i = 0; i < count; ++i) places.push_back(first + i);
  };
  if (order == around) {
    add_around(places, 0, side, n);
    add(upright, side);
    if (is_tetrahedron)
      places.push_back(3);
    else
      add_around(places, side, side, top);
    return places;
  }
  add(0, n + side);
  if (is_tetrahedron || order == edges_last) {
    add(n + side, is_tetrahedron ? side : 2 * side);
  } else {
    add(upright, side);
    add(top, side);
  }
  return places;
}

/// The place of each node of the file among corners, then inner nodes of edges, then the others.
std::vector<int> places_in_order(const ElementRow& row, NodeOrder order)
{
  std::vector<int> places;
  const int n = n_corners(row.shape);
  if (row.order == 2 && is_solid(row.shape)) return solid_places(row.shape, order);
  if (row.order == 2 && order == around && row.shape == line) return {0, 2, 1};
  if (row.order == 2 && order == around) add_around(places, 0, n, n);
  for (int k = int(places.size()); k < int(row.n_nodes); ++k) places.push_back(k);
  return places;
}

FileElement element_of_row(const ElementRow& row, ElementUse use, Format format)
{
  FileElement element{.shape = row.shape,
                      .order = row.order,
                      .n_nodes = row.n_nodes,
                      .use = use,
                      .places = places_in_order(row, order_of(row.shape, format)),
                      .n_places = 0};
  if (is_solid(row.shape)) {
    element.n_places = solid_nodes(row.shape, row.order).size();
    return element;
  }
  const std::vector<int> lattice = corners_first(row.shape, row.order);
  element.n_places = lattice.size();
  for (int& place : element.places) place = lattice[std::size_t(place)];
  return element;
}

using ElementsByName = std::map<std::pair<Format, std::string>, std::vector<FileElement>>;

ElementsByName all_elements()
{
  ElementsByName all;
  for (const FormatRule& rule : rules)
    for (const ElementRow& row : rows)
      for (const NamedUse& use : uses_in(row, rule.format))
        all[{rule.format, use.name}].push_back(element_of_row(row, use.use, rule.format));
  return all;
}

}  // namespace

const char* const no_such_solid =
    "a solid that Chladni does not have; it has tetrahedra, wedges and hexahedra of order 1 and 2: "
    "mesh the volume with these";

const std::vector<FileElement>& file_elements(Format format, std::string_view name)
{
  static const ElementsByName all = all_elements();
  static const std::vector<FileElement> none;
  const auto found = all.find(std::pair(format, std::string(name)));
  return found == all.end() ? none : found->second;
}

const FileElement& file_element(Format format, Shape shape, int order)
{
  static std::map<std::tuple<Format, Shape, int>, FileElement> known;
  const auto found = known.find({format, shape, order});
  if (found != known.end()) return found->second;
  const auto row = std::ranges::find_if(
      rows, [&](const ElementRow& each) { return each.shape == shape && each.order == order; });
  return known[{format, shape, order}] = element_of_row(*row, ElementUse::full, format);
}

std::string names_of_elements(Format format)
{
  std::vector<std::string> names;
  for (const ElementRow& row : rows)
    for (const NamedUse& use : uses_in(row, format))
      if (use.use != ElementUse::marking && std::ranges::find(names, use.name) == names.end())
        names.push_back(use.name);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

DeckElement deck_element(const FileElement& type, std::int64_t number,
                         const std::vector<std::int64_t>& nodes, int group)
{
  DeckElement element{.number = number,
                      .shape = type.shape,
                      .order = type.order,
                      .nodes = std::vector<std::int64_t>(type.n_places, 0),
                      .group = group};
  for (std::size_t k = 0; k < std::min(nodes.size(), type.places.size()); ++k)
    element.nodes[std::size_t(type.places[k])] = nodes[k];
  return element;
}

}  // namespace chladni::mesh
