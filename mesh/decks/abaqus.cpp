#include "mesh/decks/abaqus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/decks/deck.hpp"
#include "mesh/decks/file_elements.hpp"
#include "mesh/element_types.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

using std::numbers::pi;

namespace {

/// *SECTION keywords and the dimension of their elements.
const std::unordered_map<std::string, int>& section_keywords()
{
  static const std::unordered_map<std::string, int> all{
      {"SHELL SECTION", 2}, {"BEAM SECTION", 1}, {"BEAM GENERAL SECTION", 1}, {"SOLID SECTION", 3}};
  return all;
}

/// Keywords that change nothing of the linear vibrations of isotropic materials.
const std::set<std::string>& keywords_without_effect()
{
  static const std::set<std::string> all{"AMPLITUDE",           "CONDUCTIVITY",     "CREEP",
                                         "CYCLIC HARDENING",    "EXPANSION",        "FRICTION",
                                         "HARDENING",           "ORIENTATION",      "PLASTIC",
                                         "PHYSICAL CONSTANTS",  "RESTART",          "SPECIFIC HEAT",
                                         "TIME POINTS",         "SURFACE BEHAVIOR", "USER FIELD",
                                         "SURFACE INTERACTION", "DESIGNVARIABLES",  "DASHPOT"};
  return all;
}

/// What is known, and cannot be a part of a scene.
constexpr std::pair<const char*, const char*> keywords_refused[] = {
    {"CONTACT PAIR", "is a contact, and a scene is linear; take it out or join the nodes"},
    {"CONTACT", "is a contact, and a scene is linear; take it out or join the nodes"},
    {"SHELL GENERAL SECTION",
     "has no thickness and material; take *SHELL SECTION, or the matrices "
     "of the program (mesh.matrices)"},
    {"CYCLIC SYMMETRY MODEL",
     "is one sector of a body; take it and its *TIE out, turn the axis of the body into z, and say "
     "sectors = N in [mesh]"},
    {"SUBMODEL", "moves nodes as another model does; take the supports that the body has"},
    {"PRE-TENSION SECTION", "loads a bolt by an equation of its own; take the keyword out"}};

const FileElement& type_of_elements(const Keyword& keyword)
{
  const std::string& name = keyword.parameter("TYPE");
  const std::vector<FileElement>& types = file_elements(Format::abaqus, name);
  if (!types.empty()) return types.front();
  if (name.starts_with("C3D")) keyword.refuse(fmt::format("{} is {}", name, no_such_solid));
  keyword.refuse(fmt::format("{} is not known; {} are", name, names_of_elements(Format::abaqus)));
}

/// Springs, masses and dampers at nodes, and how many these are.
const std::unordered_map<std::string, std::size_t>& point_types()
{
  static const std::unordered_map<std::string, std::size_t> all{
      {"SPRINGA", 2},  {"SPRING1", 1},  {"SPRING2", 2}, {"MASS", 1},
      {"DASHPOTA", 2}, {"DASHPOT1", 1}, {"DASHPOT2", 2}};
  return all;
}

std::size_t n_nodes_of_elements(const Keyword& keyword)
{
  const auto point = point_types().find(keyword.parameter("TYPE"));
  return point == point_types().end() ? type_of_elements(keyword).n_nodes : point->second;
}

/// An element as it stands in the file: its number, then its nodes.
struct ElementRowOfKeyword {
  const KeywordRow* row;  ///< the last one of it
  std::vector<std::int64_t> numbers;
};

/// An element goes on to the next line where one ends with a comma or is full, until it has all its
/// nodes.
std::vector<ElementRowOfKeyword> elements_in(const Keyword& keyword)
{
  constexpr std::size_t full = 16;
  const std::size_t n_expected = 1 + n_nodes_of_elements(keyword);
  // Of incompatible modes, which early versions of CalculiX count as nodes.
  const std::size_t n_beyond = keyword.parameter("TYPE") == "C3D8I" ? 3 : 0;
  std::vector<ElementRowOfKeyword> all;
  bool goes_on = false;
  for (const KeywordRow& row : keyword.rows) {
    if (!goes_on) all.push_back({.row = &row, .numbers = {}});
    ElementRowOfKeyword& element = all.back();
    element.row = &row;
    std::size_t n = 0;
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
      if (row.fields[i].empty()) continue;
      element.numbers.push_back(keyword.integer(row, i, "number"));
      ++n;
    }
    goes_on = element.numbers.size() < n_expected && (row.fields.back().empty() || n == full);
    if (element.numbers.size() <= n_expected + n_beyond && element.numbers.size() > n_expected)
      element.numbers.resize(n_expected);
    if (goes_on || element.numbers.size() == n_expected) continue;
    keyword.refuse(row, fmt::format("{} numbers instead of that of the element and of {} nodes",
                                    element.numbers.size(), n_expected - 1));
  }
  if (goes_on) keyword.refuse("its last element ends with a comma");
  return all;
}

/// The one data line of a keyword.
const KeywordRow& only_row(const Keyword& keyword)
{
  if (keyword.rows.size() != 1)
    keyword.refuse(fmt::format("needs one data line, has {}", keyword.rows.size()));
  return keyword.rows.front();
}

/// Components of a boundary condition by its name, from 0.
std::optional<std::vector<int>> components_named(std::string_view name)
{
  if (name == "ENCASTRE") return std::vector<int>{0, 1, 2, 3, 4, 5};
  if (name == "PINNED") return std::vector<int>{0, 1, 2};
  if (name == "XSYMM") return std::vector<int>{0, 4, 5};
  if (name == "YSYMM") return std::vector<int>{1, 3, 5};
  if (name == "ZSYMM") return std::vector<int>{2, 3, 4};
  return std::nullopt;
}

/// Temperatures, pressures and flows.
bool is_of_no_motion(const Keyword& boundary, const KeywordRow& row)
{
  return Keyword::field(row, 1) == "11" || Keyword::field(row, 1) == "0" ||
         boundary.has("TEMPERATURE") || boundary.has("PRESSURE") || boundary.has("MASS FLOW") ||
         boundary.has("MASSFLOW");
}

/// Those that a row of *BOUNDARY holds.
std::vector<int> held_components(const Keyword& keyword, const KeywordRow& row)
{
  if (const auto named = components_named(Keyword::field(row, 1))) return *named;
  const std::int64_t first = keyword.integer(row, 1, "component");
  const bool is_one = Keyword::field(row, 2).empty();
  const std::int64_t last = is_one ? first : keyword.integer(row, 2, "component");
  if (first > last || last > 6)
    keyword.refuse(row, fmt::format("{} to {} are no components of 1 to 6", first, last));
  std::vector<int> held;
  for (std::int64_t c = first; c <= last; ++c) held.push_back(static_cast<int>(c) - 1);
  return held;
}

/// Springs, masses and dampers with the keyword of their property; null where there is none.
struct AbaqusPoint {
  std::int64_t number;
  std::vector<std::int64_t> nodes;
  const Keyword* elements;
  const KeywordRow* row;
  const Keyword* property;

  const std::string& type() const { return elements->parameter("TYPE"); }
  std::string group(std::size_t end) const
  {
    return type() == "MASS" ? fmt::format("mass_{}", number)
                            : fmt::format("spring_{}_{}", number, end + 1);
  }
};

/// The coordinate axis of the line between two nodes; absent of skew ones.
std::optional<std::size_t> axis_between(const Deck& deck, const std::vector<std::int64_t>& nodes)
{
  constexpr double straight = 1e-6;
  const auto a = deck.nodes.find(nodes[0]), b = deck.nodes.find(nodes[1]);
  if (a == deck.nodes.end() || b == deck.nodes.end()) return std::nullopt;
  const Vector along = minus(b->second, a->second);
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(along[c]) > 0.0 && std::abs(along[c]) >= (1.0 - straight) * norm(along)) return c;
  return std::nullopt;
}

/// Whether two nodes are at a distance across a displacement (0 to 2), where a spring of a scene,
/// which acts midway between them, is not one of the difference of their motions.
bool are_apart_across(const Deck& deck, const std::vector<std::int64_t>& nodes,
                      std::size_t component)
{
  constexpr double same_place = 1e-9;
  const Vector &a = deck.nodes.at(nodes[0]), &b = deck.nodes.at(nodes[1]);
  Vector across = minus(b, a);
  across[component] = 0.0;
  return norm(across) > same_place * (norm(a) + norm(b));
}

/// A bar without bending: an element T3D2 that a solid section names.
struct AbaqusTruss {
  std::int64_t number;
  std::array<std::int64_t, 2> nodes;
  const Keyword* section;
  std::string place;

  std::string group() const { return fmt::format("truss_{}", number); }
};

std::vector<AbaqusTruss> abaqus_trusses(std::span<const Keyword> model, const AbaqusSets& sets)
{
  std::map<std::int64_t, const Keyword*> section_of;
  for (const Keyword& keyword : model)
    if (keyword.name == "SOLID SECTION" && sets.elements.contains(keyword.parameter("ELSET")))
      for (const std::int64_t number : sets.elements.at(keyword.parameter("ELSET")))
        section_of[number] = &keyword;
  std::vector<AbaqusTruss> trusses;
  for (const Keyword& keyword : model) {
    if (keyword.name != "ELEMENT" || keyword.parameter("TYPE") != "T3D2") continue;
    for (const ElementRowOfKeyword& element : elements_in(keyword)) {
      const auto section = section_of.find(element.numbers[0]);
      if (section == section_of.end()) continue;
      trusses.push_back({.number = element.numbers[0],
                         .nodes = {element.numbers[1], element.numbers[2]},
                         .section = section->second,
                         .place = element.row->place});
    }
  }
  return trusses;
}

std::vector<AbaqusPoint> abaqus_points(std::span<const Keyword> model, const AbaqusSets& sets)
{
  std::map<std::int64_t, const Keyword*> property_of;
  for (const Keyword& keyword : model) {
    if (keyword.name != "SPRING" && keyword.name != "MASS") continue;
    const auto set = sets.elements.find(keyword.parameter("ELSET"));
    if (set == sets.elements.end())
      keyword.refuse(fmt::format("there is no element set \"{}\"", keyword.parameter("ELSET")));
    for (const std::int64_t number : set->second) property_of[number] = &keyword;
  }
  std::vector<AbaqusPoint> points;
  for (const Keyword& keyword : model) {
    if (keyword.name != "ELEMENT" || !point_types().contains(keyword.parameter("TYPE"))) continue;
    for (const ElementRowOfKeyword& element : elements_in(keyword)) {
      const std::int64_t number = element.numbers.front();
      const auto property = property_of.find(number);
      points.push_back({.number = number,
                        .nodes = {element.numbers.begin() + 1, element.numbers.end()},
                        .elements = &keyword,
                        .row = element.row,
                        .property = property == property_of.end() ? nullptr : property->second});
    }
  }
  return points;
}

/// The axes of the nodes of *TRANSFORM.
std::map<std::int64_t, DeckAxes> transformed_axes(std::span<const Keyword> model,
                                                  const AbaqusSets& sets, const Deck& deck)
{
  std::map<std::int64_t, DeckAxes> all;
  for (const Keyword& keyword : model) {
    if (keyword.name != "TRANSFORM") continue;
    keyword.expect_only({"NSET", "TYPE"});
    const bool is_cylindrical = keyword.has("TYPE") && keyword.parameter("TYPE") == "C";
    if (keyword.has("TYPE") && !is_cylindrical && keyword.parameter("TYPE") != "R")
      keyword.refuse("is known with TYPE = R and C alone");
    const KeywordRow& row = only_row(keyword);
    const auto point = [&](std::size_t first) {
      Vector x{};
      for (std::size_t c = 0; c < 3; ++c) x[c] = keyword.real_or(row, first + c, "a length", 0.0);
      return x;
    };
    const Vector a = point(0), b = point(3);
    const auto straight = [&](const Vector& v) {
      if (!(norm(v) > 0.0)) keyword.refuse(row, "its two points give no axes");
      return unit(v);
    };
    for (const std::int64_t node : abaqus_nodes(keyword, row, keyword.parameter("NSET"), sets)) {
      const auto at = deck.nodes.find(node);
      if (at == deck.nodes.end()) continue;
      if (is_cylindrical) {
        const Vector axis = straight(minus(b, a)), arm = minus(at->second, a);
        Vector radial = arm;
        for (std::size_t c = 0; c < 3; ++c) radial[c] -= dot(arm, axis) * axis[c];
        if (norm(radial) <= 1e-9 * norm(arm)) continue;  // on the axis: the global ones
        radial = unit(radial);
        all[node] = {radial, cross(axis, radial), axis};
      } else {
        const Vector x = straight(a), z = straight(cross(a, b));
        all[node] = {x, cross(z, x), z};
      }
    }
  }
  return all;
}

/// The group of the nodes of a row of *BOUNDARY whose components are global ones.
std::string name_of_others(const KeywordRow& row)
{
  std::string name = "boundary_" + row.place;
  std::ranges::replace(name, ' ', '_');
  return name;
}

class AbaqusReader {
 public:
  explicit AbaqusReader(std::span<const Keyword> keywords)
      : keywords_(keywords), sets_(abaqus_sets(keywords))
  {}

  Deck read()
  {
    find_section_sets();
    const std::span<const Keyword> model = abaqus_model(keywords_);
    for (const Keyword& keyword : model)
      if (keyword.name == "NODE") nodes(keyword);
    deck_.axes = transformed_axes(model, sets_, deck_);
    for (const Keyword& keyword : model)
      if (keyword.name != "NODE") read(keyword);
    const NodesOfDeck known(deck_);
    const Holders holders(deck_);
    for (const AbaqusPoint& point : abaqus_points(model, sets_)) add_point(point, known, holders);
    for (const AbaqusTruss& truss : abaqus_trusses(model, sets_)) {
      points_[truss.number] = {truss.nodes.begin(), truss.nodes.end()};
      add_elongation(
          deck_, known,
          {.entry = truss.place + ": *ELEMENT", .group = truss.group(), .nodes = truss.nodes});
      for (const std::size_t end : {0U, 1U}) {
        deck_
            .groups[std::size_t(
                group_index(deck_, fmt::format("{}_{}", truss.group(), end + 1), 0))]
            .nodes = {truss.nodes[end]};
      }
    }
    hold_in_axes(model);
    add_sets();
    couple();
    refuse_rotations(model);
    note_reduced();
    for (const auto& [name, n] : left_out_) {
      deck_.notes.push_back(
          fmt::format("{} *{} are left out: linear vibrations have no use for it", n, name));
    }
    note_steps();
    return std::move(deck_);
  }

 private:
  using ReadKeyword = void (AbaqusReader::*)(const Keyword&);

  void note_steps()
  {
    const std::size_t n_of_model = abaqus_model(keywords_).size();
    if (n_of_model == keywords_.size()) return;
    deck_.notes.emplace_back("steps are left out, except the supports of the first one");
    for (const Keyword& keyword : keywords_.subspan(n_of_model))
      if (keyword.name == "BOUNDARY") {
        deck_.notes.push_back(
            fmt::format("{}: *BOUNDARY of a later step is left out", keyword.place));
      }
  }

  void instance(const Keyword& keyword)
  {
    if (keyword.parameter("OFFSET") == "0") return;
    deck_.notes.push_back(
        fmt::format("the nodes and elements of the instance \"{}\" are numbered from {} on",
                    keyword.parameter("NAME"), keyword.parameter("OFFSET")));
  }

  void read(const Keyword& keyword)
  {
    static const std::unordered_map<std::string, ReadKeyword> readers{
        {"ELEMENT", &AbaqusReader::elements},
        {"SURFACE", &AbaqusReader::surface},
        {"INSTANCE", &AbaqusReader::instance},
        {"BOUNDARY", &AbaqusReader::boundary},
        {"EQUATION", &AbaqusReader::equations}};
    // Read elsewhere, or nothing to a mesh.
    static const std::set<std::string> known{
        "HEADING",  "NSET",      "ELSET",     "MATERIAL",        "ELASTIC",      "DENSITY",
        "COUPLING", "KINEMATIC", "PREPRINT",  "RIGID BODY",      "DISTRIBUTING", "MPC",
        "SPRING",   "MASS",      "TRANSFORM", "NODAL THICKNESS", "TIE"};
    const auto reader = readers.find(keyword.name);
    if (reader != readers.end()) return (this->*reader->second)(keyword);
    if (known.contains(keyword.name) || section_keywords().contains(keyword.name)) return;
    static const std::set<std::string> begins{"TEMPERATURE", "VELOCITY", "DISPLACEMENT",
                                              "PLASTIC STRAIN"};
    const bool is_start = keyword.name == "INITIAL CONDITIONS" && keyword.has("TYPE") &&
                          begins.contains(keyword.parameter("TYPE"));
    if (keyword.name == "DAMPING") {
      deck_.notes.push_back(
          fmt::format("{}: *DAMPING is left out: say damping in [body]", keyword.place));
      return;
    }
    if (is_start || keywords_without_effect().contains(keyword.name)) {
      ++left_out_[keyword.name];
      return;
    }
    if (keyword.name == "INITIAL CONDITIONS" && keyword.has("TYPE") &&
        keyword.parameter("TYPE") == "STRESS")
      keyword.refuse("prestresses the body, which changes its stiffness; a scene begins at rest");
    for (const auto& [name, why] : keywords_refused)
      if (keyword.name == name) keyword.refuse(why);
    keyword.refuse("this keyword is not known; take it out if the model is the same without it");
  }

  /// Each element is of the group that a section names, or else of its own ELSET.
  void find_section_sets()
  {
    for (const Keyword& keyword : abaqus_model(keywords_)) {
      const auto of_section = section_keywords().find(keyword.name);
      if (of_section == section_keywords().end()) continue;
      const std::string& set = keyword.parameter("ELSET");
      const auto elements = sets_.elements.find(set);
      if (elements == sets_.elements.end())
        keyword.refuse(fmt::format("there is no element set \"{}\"", set));
      for (const std::int64_t element : elements->second) {
        const SectionOfSet section{
            .set = set, .keyword = &keyword, .dimension = of_section->second};
        if (!section_of_.emplace(element, section).second)
          keyword.refuse(fmt::format("element {} has two sections", element));
      }
    }
  }

  void nodes(const Keyword& keyword)
  {
    keyword.expect_only({"NSET"});
    for (const KeywordRow& row : keyword.rows) {
      const std::int64_t number = keyword.integer(row, 0, "number of a node");
      std::array<double, 3> x{};
      for (std::size_t c = 0; c < 3; ++c) x[c] = keyword.real_or(row, 1 + c, "a coordinate", 0.0);
      if (!deck_.nodes.emplace(number, x).second)
        keyword.refuse(row, fmt::format("node {} is there twice", number));
    }
  }

  void elements(const Keyword& keyword)
  {
    keyword.expect_only({"TYPE", "ELSET"});
    if (point_types().contains(keyword.parameter("TYPE"))) return;
    const FileElement& type = type_of_elements(keyword);
    const std::vector<ElementRowOfKeyword> all = elements_in(keyword);
    for (const ElementRowOfKeyword& element : all)
      add_element(keyword, *element.row, type, element.numbers);
    if (type.use == ElementUse::reduced) n_reduced_[keyword.parameter("TYPE")] += all.size();
  }

  void add_element(const Keyword& keyword, const KeywordRow& row, const FileElement& type,
                   const std::vector<std::int64_t>& numbers)
  {
    const std::int64_t number = numbers.front();
    if (!place_of_.emplace(number, deck_.elements.size()).second)
      keyword.refuse(row, fmt::format("element {} is there twice", number));
    const auto section = section_of_.find(number);
    if (section != section_of_.end() && section->second.keyword->name == "SOLID SECTION" &&
        keyword.parameter("TYPE") == "T3D2") {
      place_of_.erase(number);
      return;  // a truss
    }
    const std::string name = section != section_of_.end() ? section->second.set
                             : keyword.has("ELSET")       ? keyword.parameter("ELSET")
                                                          : "ELEMENTS";
    const int d = dimension(type.shape);
    if (section != section_of_.end() &&
        (section->second.dimension != d || type.use == ElementUse::marking)) {
      section->second.keyword->refuse(
          fmt::format("\"{}\" holds element {} of the type {}, which is none of this section", name,
                      number, keyword.parameter("TYPE")));
    }
    const int group = group_index(deck_, name, d);
    if (deck_.groups[std::size_t(group)].dimension != d) {
      keyword.refuse(
          row,
          fmt::format("\"{}\" holds elements of two kinds, as shells and beams, or solids", name));
    }
    deck_.elements.push_back(
        deck_element(type, number, {numbers.begin() + 1, numbers.end()}, group));
    deck_.elements.back().place = row.place;
    deck_.elements.back().marks = type.use == ElementUse::marking;
  }

  /// Its nodes become groups; dampers are left out.
  void add_point(const AbaqusPoint& point, const NodesOfDeck& known, const Holders& holders)
  {
    points_[point.number] = point.nodes;
    if (point.type().starts_with("DASHPOT")) {
      ++left_out_["DASHPOT"];
      return;
    }
    if (point.property == nullptr) {
      point.elements->refuse(*point.row, fmt::format("element {} has no *{}", point.number,
                                                     point.type() == "MASS" ? "MASS" : "SPRING"));
    }
    if (point.type() == "SPRINGA" && !axis_between(deck_, point.nodes)) {
      return add_elongation(deck_, known,
                            {.entry = point.row->place + ": *ELEMENT",
                             .group = point.group(0),
                             .nodes = {point.nodes[0], point.nodes[1]}});
    }
    for (std::size_t end = 0; end < point.nodes.size(); ++end) {
      if (!deck_.nodes.contains(point.nodes[end]))
        point.elements->refuse(*point.row, fmt::format("there is no node {}", point.nodes[end]));
      const int group = group_index(deck_, point.group(end), 0);
      deck_.groups[std::size_t(group)].nodes = {point.nodes[end]};
    }
    if (point.type() == "SPRING2" && holders.is_in_mesh(point.nodes[0]) &&
        holders.is_in_mesh(point.nodes[1]))
      add_difference(point);
  }

  /// Of a displacement of nodes apart or with axes of their own: a new node has it as its own, in
  /// the place of the first one.
  void add_difference(const AbaqusPoint& point)
  {
    const std::vector<KeywordRow>& rows = point.property->rows;
    if (rows.empty() || Keyword::field(rows[0], 0) != Keyword::field(rows[0], 1)) return;
    const auto c = std::size_t(point.property->integer(rows[0], 0, "component")) - 1;
    const auto has_axes = [&](std::int64_t node) { return deck_.axes.contains(node); };
    if (c > 2 ||
        (!are_apart_across(deck_, point.nodes, c) && std::ranges::none_of(point.nodes, has_axes)))
      return;
    const std::int64_t added = deck_.nodes.rbegin()->first + 1;
    deck_.nodes[added] = deck_.nodes.at(point.nodes[0]);
    deck_.groups[std::size_t(group_index(deck_, point.group(0), 0))].nodes = {added};
    DeckEquation equation{.entry = point.row->place + ": *ELEMENT",
                          .terms = {{added, int(c), -1.0}}};
    add_term(deck_, equation, {point.nodes[1], int(c), 1.0});
    add_term(deck_, equation, {point.nodes[0], int(c), -1.0});
    deck_.equations.push_back(std::move(equation));
  }

  /// The number of terms, then a node or a set, a component and a factor of each, in as many rows
  /// as it takes.
  void equations(const Keyword& keyword)
  {
    keyword.expect_only({});
    for (std::size_t i = 0; i < keyword.rows.size();) {
      const KeywordRow& first = keyword.rows[i];
      const auto n_fields = 3 * std::size_t(keyword.integer(first, 0, "number of terms"));
      KeywordRow all{.place = first.place, .fields = {}};
      for (++i; i < keyword.rows.size() && all.fields.size() < n_fields; ++i) {
        std::ranges::copy_if(keyword.rows[i].fields, std::back_inserter(all.fields),
                             [](const std::string& field) { return !field.empty(); });
      }
      if (all.fields.size() != n_fields) {
        keyword.refuse(first,
                       fmt::format("has {} numbers instead of a node, a component and a factor for "
                                   "each of its {} terms",
                                   all.fields.size(), n_fields / 3));
      }
      add_equations(keyword, all);
    }
  }

  /// One, or one for each node of the sets.
  void add_equations(const Keyword& keyword, const KeywordRow& row)
  {
    std::vector<std::vector<std::int64_t>> nodes;
    for (std::size_t k = 0; k < row.fields.size(); k += 3) {
      nodes.push_back(abaqus_nodes(keyword, row, row.fields[k], sets_));
      if (nodes.back().empty())
        keyword.refuse(row, fmt::format("the set \"{}\" has no nodes", row.fields[k]));
      if (nodes.back().size() != 1 && nodes.back().size() != nodes.front().size()) {
        keyword.refuse(row, fmt::format("\"{}\" has {} nodes, where its first term has {}",
                                        row.fields[k], nodes.back().size(), nodes.front().size()));
      }
    }
    const std::size_t n = nodes.front().size();
    for (std::size_t e = 0; e < n; ++e) {
      DeckEquation equation{.entry = row.place + ": *EQUATION", .terms = {}};
      for (std::size_t t = 0; t < nodes.size(); ++t) {
        const std::int64_t component = keyword.integer(row, 3 * t + 1, "component");
        if (component == 11) return;  // of temperatures
        if (component > 6)
          keyword.refuse(row, fmt::format("{} is no component of 1 to 6", component));
        add_term(deck_, equation,
                 {nodes[t][nodes[t].size() == 1 ? 0 : e], int(component) - 1,
                  keyword.real(row, 3 * t + 2, "a factor")});
      }
      deck_.equations.push_back(std::move(equation));
    }
  }

  /// Supports in axes of *TRANSFORM; nodes without such axes get a group of their own.
  void hold_in_axes(std::span<const Keyword> model)
  {
    if (deck_.axes.empty()) return;
    const NodesOfDeck known(deck_);
    std::set<std::int64_t> loose;  // if of no element
    for (const auto& [number, nodes] : points_) loose.insert(nodes.begin(), nodes.end());
    for (const DeckEquation& equation : deck_.equations)
      for (const DeckEquation::Term& term : equation.terms) loose.insert(term.node);
    for (const Keyword& keyword : model) {
      if (keyword.name != "BOUNDARY") continue;
      for (const KeywordRow& row : keyword.rows) {
        if (is_of_no_motion(keyword, row)) continue;
        const std::vector<int> held = held_components(keyword, row);
        const auto nodes = abaqus_nodes(keyword, row, row.fields.front(), sets_);
        const auto others = held_in_basic_axes(deck_, nodes, held);
        for (const std::int64_t node : nodes) {
          if (!deck_.axes.contains(node) || known.connected.contains(node) ||
              !loose.contains(node) || are_whole(held))
            continue;
          keyword.refuse(row, fmt::format("node {} of a spring or an equation has a *TRANSFORM and "
                                          "belongs to no element; take it out of the *TRANSFORM",
                                          node));
        }
        mesh::hold_in_axes(
            deck_, known, {.entry = row.place + ": *BOUNDARY", .nodes = nodes, .components = held});
        if (others.size() < nodes.size())
          deck_.groups[std::size_t(group_index(deck_, name_of_others(row), 0))].nodes = others;
      }
    }
  }

  /// Of a ROT NODE, only those of *BOUNDARY are known as rotations.
  void refuse_rotations(std::span<const Keyword> model) const
  {
    for (const Keyword& keyword : model) {
      if (keyword.name != "RIGID BODY" || !keyword.has("ROT NODE")) continue;
      const std::int64_t node =
          only_node(keyword, {keyword.place, {}}, keyword.parameter("ROT NODE"));
      const auto refuse = [&](std::string_view where) {
        keyword.refuse(fmt::format(
            "its ROT NODE {} is in {}, where only *BOUNDARY can name it; take REF NODE and its "
            "components 4 to 6",
            node, where));
      };
      if (deck_.axes.contains(node)) refuse("a *TRANSFORM");
      for (const DeckEquation& equation : deck_.equations)
        for (const DeckEquation::Term& term : equation.terms)
          if (term.node == node) refuse(equation.entry);
      for (const auto& [number, nodes] : points_)
        if (std::ranges::find(nodes, node) != nodes.end())
          refuse(fmt::format("element {}", number));
      for (const DeckCoupling& coupling : deck_.couplings)
        if (coupling.reference == node) refuse(coupling.entry);
    }
  }

  /// Nodes of the first surface follow faces of the second one.
  void tie(const Keyword& keyword)
  {
    if (keyword.has("CYCLIC SYMMETRY")) {
      keyword.refuse(
          "joins the sides of one sector of a body; take it out, turn the axis of the body into z, "
          "and say sectors = N in [mesh]");
    }
    keyword.expect_only({"NAME", "POSITION TOLERANCE", "ADJUST", "TYPE", "NO ROTATION"});
    for (const KeywordRow& row : keyword.rows) {
      std::array<std::string, 2> groups;
      for (std::size_t i = 0; i < 2; ++i) {
        groups[i] = fmt::format("surface_{}", Keyword::field(row, i));
        if (std::ranges::find(deck_.groups, groups[i], &DeckGroup::name) == deck_.groups.end())
          keyword.refuse(row, fmt::format("there is no surface \"{}\"", Keyword::field(row, i)));
      }
      const KeywordRow own{
          .place = keyword.place,
          .fields = {keyword.has("POSITION TOLERANCE") ? keyword.parameter("POSITION TOLERANCE")
                                                       : ""}};
      deck_.ties.push_back(
          {.entry = row.place + ": *TIE",
           .nodes = groups[0],
           .faces = groups[1],
           .gap = {},
           .moves = !keyword.has("ADJUST") || keyword.parameter("ADJUST") != "NO"});
      if (!own.fields.front().empty()) deck_.ties.back().gap = keyword.real(own, 0, "a tolerance");
    }
  }

  void note_reduced()
  {
    for (const auto& [name, n] : n_reduced_) {
      deck_.notes.push_back(fmt::format(
          "{} elements {} are read as those of full integration and displacements alone", n, name));
    }
  }

  void surface(const Keyword& keyword)
  {
    keyword.expect_only({"NAME", "TYPE", "INTERNAL"});
    const std::string name = fmt::format("surface_{}", keyword.parameter("NAME"));
    const bool is_of_nodes = keyword.has("TYPE") && keyword.parameter("TYPE") == "NODE";
    DeckGroup& group = deck_.groups[std::size_t(group_index(deck_, name, 0))];
    for (const KeywordRow& row : keyword.rows) {
      const std::string& set = row.fields.front();
      const std::vector<std::int64_t> found =
          is_of_nodes ? abaqus_nodes(keyword, row, set, sets_) : nodes_of_faces(keyword, row);
      group.nodes.insert(group.nodes.end(), found.begin(), found.end());
      const std::string_view side = Keyword::field(row, 1);
      group.is_of_faces = group.is_of_faces || (side.size() == 2 && side[0] == 'S');
    }
  }

  /// The elements that a row of a surface names by a set or by a number.
  std::vector<std::int64_t> elements_of(const Keyword& keyword, const KeywordRow& row) const
  {
    const std::string& name = row.fields.front();
    if (keyword.is_integer(name)) return {keyword.integer(row, 0, "number of an element")};
    const auto set = sets_.elements.find(name);
    if (set == sets_.elements.end())
      keyword.refuse(row, fmt::format("there is no element set \"{}\"", name));
    return set->second;
  }

  /// The nodes of faces S1 to S6 of solids, of shells of which one side or other is meant, or of an
  /// edge of these, E1 to E4.
  std::vector<std::int64_t> nodes_of_faces(const Keyword& keyword, const KeywordRow& row) const
  {
    const std::string_view side = Keyword::field(row, 1);
    const bool is_part = side.size() == 2 && (side[0] == 'E' || side[0] == 'S') && side[1] >= '1' &&
                         side[1] <= (side[0] == 'E' ? '4' : '6');
    if (!side.empty() && side != "SPOS" && side != "SNEG" && !is_part) {
      keyword.refuse(row,
                     fmt::format("{}: only faces of solids, S1 to S6, sides of shells, SPOS or "
                                 "SNEG, and their edges, E1 to E4, are known",
                                 side));
    }
    std::vector<std::int64_t> nodes;
    for (const std::int64_t number : elements_of(keyword, row)) {
      const auto found = place_of_.find(number);
      if (found == place_of_.end())
        keyword.refuse(row, fmt::format("there is no element {}", number));
      const DeckElement& element = deck_.elements[found->second];
      const std::vector<std::int64_t> of_part = part_of(element, is_part ? side : "");
      if (of_part.empty()) {
        keyword.refuse(row,
                       is_solid(element.shape) && side.empty()
                           ? fmt::format("element {} is a solid; name its face, S1 to S6", number)
                           : fmt::format("element {} has no {} {}", number,
                                         side.starts_with('E') ? "edge" : "face", side));
      }
      std::ranges::copy_if(of_part, std::back_inserter(nodes),
                           [](std::int64_t node) { return node != 0; });
    }
    return nodes;
  }

  /// The nodes of a face or an edge; empty where an element has none of this name.
  /// @param side  "S1", "E1" or, of a side of a shell, ""
  static std::vector<std::int64_t> part_of(const DeckElement& element, std::string_view side)
  {
    std::vector<std::vector<int>> parts;
    const bool is_side = side.empty() || side == "S1" || side == "S2";  // as CalculiX calls them
    if (is_side && !is_solid(element.shape)) return element.nodes;
    if (side.empty()) return {};
    if (side[0] == 'S' && is_solid(element.shape))
      parts = solid_faces(element.shape, element.order);
    if (side[0] == 'E' && is_surface(element.shape))
      parts = edges_around(element.shape, element.order);
    const auto i = std::size_t(side[1] - '1');
    if (i >= parts.size()) return {};
    std::vector<std::int64_t> nodes;
    for (const int place : parts[i]) nodes.push_back(element.nodes[std::size_t(place)]);
    return nodes;
  }

  /// The places of the edges of a shell from its first corner on: places_of_edges goes by rows and
  /// columns.
  static std::vector<std::vector<int>> edges_around(Shape shape, int order)
  {
    const std::vector<std::vector<int>> edges = places_of_edges(shape, order);
    if (shape == Shape::triangle) return {edges[0], edges[2], edges[1]};
    return {edges[0], edges[2], edges[3], edges[1]};
  }

  /// Couplings, whose kind stands in the keyword behind.
  void couple()
  {
    const std::span<const Keyword> model = abaqus_model(keywords_);
    for (std::size_t i = 0; i < model.size(); ++i)
      if (model[i].name == "COUPLING")
        coupling(model[i], i + 1 < model.size() ? &model[i + 1] : nullptr);
    for (const Keyword& keyword : model) {
      if (keyword.name == "RIGID BODY") rigid_body(keyword);
      if (keyword.name == "MPC") constraints(keyword);
      if (keyword.name == "TIE") tie(keyword);
    }
    add_leaders(deck_);
  }

  /// Nodes that follow a reference as a rigid body; what names the same group and reference again
  /// adds to it.
  void follow(const Keyword& keyword, const std::string& group, std::int64_t reference,
              std::vector<std::int64_t> nodes)
  {
    std::erase(nodes, reference);
    if (nodes.empty()) keyword.refuse("has no nodes that follow");
    std::vector<std::int64_t>& all = deck_.groups[std::size_t(group_index(deck_, group, 0))].nodes;
    all.insert(all.end(), nodes.begin(), nodes.end());
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (std::ranges::find(deck_.couplings, group, &DeckCoupling::group) != deck_.couplings.end())
      return;
    deck_.couplings.push_back({.entry = fmt::format("{}: *{}", keyword.place, keyword.name),
                               .reference = reference,
                               .group = group,
                               .averages = false});
  }

  std::int64_t only_node(const Keyword& keyword, const KeywordRow& row, std::string_view name) const
  {
    const std::vector<std::int64_t> nodes = abaqus_nodes(keyword, row, name, sets_);
    if (nodes.size() != 1)
      keyword.refuse(row, fmt::format("\"{}\" is {} nodes instead of one", name, nodes.size()));
    return nodes.front();
  }

  /// Nodes of TIE NSET, of PIN NSET (of solids, which do not turn), and of the elements of ELSET.
  void rigid_body(const Keyword& keyword)
  {
    keyword.expect_only(
        {"REF NODE", "TIE NSET", "PIN NSET", "ELSET", "NSET", "POSITION", "ROT NODE"});
    if (keyword.has("POSITION") && keyword.parameter("POSITION") != "INPUT")
      keyword.refuse("moves its reference node to the centre of mass; take POSITION = INPUT");
    const KeywordRow row{keyword.place, {}};
    const std::int64_t reference = only_node(keyword, row, keyword.parameter("REF NODE"));
    std::vector<std::int64_t> nodes;
    const auto add = [&](const std::vector<std::int64_t>& more) {
      std::ranges::copy_if(more, std::back_inserter(nodes), [](std::int64_t n) { return n != 0; });
    };
    for (const char* set : {"TIE NSET", "NSET"})
      if (keyword.has(set)) add(abaqus_nodes(keyword, row, keyword.parameter(set), sets_));
    if (keyword.has("PIN NSET")) {
      add(abaqus_nodes(keyword, row, keyword.parameter("PIN NSET"), sets_));
      if (have_rotations(deck_, nodes))
        keyword.refuse("PIN NSET leaves rotations of nodes of shells or beams free; take TIE NSET");
    }
    if (keyword.has("ELSET")) {
      const auto set = sets_.elements.find(keyword.parameter("ELSET"));
      if (set == sets_.elements.end())
        keyword.refuse(fmt::format("there is no element set \"{}\"", keyword.parameter("ELSET")));
      for (const std::int64_t number : set->second)
        if (const auto found = place_of_.find(number); found != place_of_.end())
          add(deck_.elements[found->second].nodes);
    }
    follow(keyword, fmt::format("rigid_body_{}", reference), reference, std::move(nodes));
  }

  /// BEAM: the first node, or each of the set, follows the second one.
  void constraints(const Keyword& keyword)
  {
    keyword.expect_only({});
    for (const KeywordRow& row : keyword.rows) {
      const std::string& type = row.fields.front();
      if (type != "BEAM" && type != "TIE") {
        keyword.refuse(row,
                       fmt::format("the type {} is not known; BEAM and TIE, which join rigidly, "
                                   "are",
                                   type));
      }
      if (row.fields.size() != 3 || row.fields[1].empty() || row.fields[2].empty())
        keyword.refuse(row, "must be the type, the node that follows or a set, and one node");
      const std::int64_t leader = only_node(keyword, row, row.fields[2]);
      const std::vector<std::int64_t> nodes = abaqus_nodes(keyword, row, row.fields[1], sets_);
      if (type == "TIE") check_together(keyword, row, nodes, leader);
      follow(keyword, fmt::format("mpc_{}", leader), leader, nodes);
    }
  }

  /// Equal motions are rigid where the nodes are at one place.
  void check_together(const Keyword& keyword, const KeywordRow& row,
                      const std::vector<std::int64_t>& nodes, std::int64_t leader) const
  {
    constexpr double same_place = 1e-6;
    const auto at = deck_.nodes.find(leader);
    for (const std::int64_t node : nodes) {
      const auto other = deck_.nodes.find(node);
      if (at == deck_.nodes.end() || other == deck_.nodes.end()) {
        keyword.refuse(row,
                       fmt::format("there is no node {}", at == deck_.nodes.end() ? leader : node));
      }
      if (norm(minus(at->second, other->second)) <= same_place * norm(at->second)) continue;
      keyword.refuse(row,
                     fmt::format("its nodes {} and {} are apart, where equal displacements and "
                                 "rotations are no rigid link; take BEAM",
                                 node, leader));
    }
  }

  void coupling(const Keyword& keyword, const Keyword* kind)
  {
    keyword.expect_only({"CONSTRAINT NAME", "REF NODE", "SURFACE"});
    const bool averages = kind != nullptr && kind->name == "DISTRIBUTING";
    if (kind == nullptr || (!averages && kind->name != "KINEMATIC"))
      keyword.refuse("has neither *KINEMATIC nor *DISTRIBUTING behind it");
    kind->expect_only(averages ? std::set<std::string>{"WEIGHTING METHOD"}
                               : std::set<std::string>{});
    const std::vector<std::int64_t> nodes =
        abaqus_nodes(keyword, {keyword.place, {}}, keyword.parameter("REF NODE"), sets_);
    if (nodes.size() != 1) keyword.refuse("its reference is not one node");
    const std::string group = "surface_" + keyword.parameter("SURFACE");
    const auto followers = std::ranges::find(deck_.groups, group, &DeckGroup::name);
    if (followers == deck_.groups.end())
      keyword.refuse(fmt::format("there is no surface \"{}\"", keyword.parameter("SURFACE")));
    const std::string entry = fmt::format("{}: *COUPLING", keyword.place);
    const std::vector<int> coupled = coupled_components(*kind);
    const bool have_turns = averages || have_rotations(deck_, followers->nodes);
    const auto is_coupled = [&](int c) { return std::ranges::find(coupled, c) != coupled.end(); };
    if (is_coupled(0) && is_coupled(1) && is_coupled(2) &&
        (!have_turns || (is_coupled(3) && is_coupled(4) && is_coupled(5)))) {
      deck_.couplings.push_back(
          {.entry = entry, .reference = nodes.front(), .group = group, .averages = averages});
      return;
    }
    if (averages) kind->refuse("couples not all components 1 to 6; a scene's average does");
    const NodesOfDeck known(deck_);
    for (const std::int64_t node : followers->nodes)
      for (const int c : coupled)
        if (c < 3 || known.rotating.contains(node))
          add_rigid_equations(deck_, entry, nodes.front(), node, {c});
  }

  /// From 0; all six need no data line.
  static std::vector<int> coupled_components(const Keyword& kind)
  {
    if (kind.rows.empty()) return {0, 1, 2, 3, 4, 5};
    std::vector<int> all;
    for (const KeywordRow& row : kind.rows) {
      const std::int64_t first = kind.integer(row, 0, "component");
      const bool is_one = Keyword::field(row, 1).empty();
      const std::int64_t last = is_one ? first : kind.integer(row, 1, "component");
      for (std::int64_t c = first; c <= std::min<std::int64_t>(last, 6); ++c)
        all.push_back(static_cast<int>(c) - 1);
    }
    return all;
  }

  /// A node that is named by its number gets a group.
  void boundary(const Keyword& keyword)
  {
    for (const KeywordRow& row : keyword.rows) {
      const std::string& name = row.fields.front();
      if (!keyword.is_integer(name)) continue;
      const int group = group_index(deck_, "boundary_" + name, 0);
      deck_.groups[std::size_t(group)].nodes = abaqus_nodes(keyword, row, name, sets_);
    }
  }

  void add_sets()
  {
    for (const auto& [name, numbers] : sets_.nodes) {
      std::vector<std::int64_t>& nodes =
          deck_.groups[std::size_t(group_index(deck_, name_of_node_set(name, sets_), 0))].nodes;
      std::ranges::copy_if(numbers, std::back_inserter(nodes),
                           [&](std::int64_t node) { return deck_.nodes.contains(node); });
      if (nodes.size() == numbers.size()) continue;
      deck_.notes.push_back(fmt::format("*NSET {}: {} of its nodes are not there, and left out",
                                        name, numbers.size() - nodes.size()));
    }
    for (const auto& [name, numbers] : sets_.elements) {
      const auto is_used = std::ranges::find(deck_.groups, name, &DeckGroup::name);
      if (is_used != deck_.groups.end() && is_used->dimension > 0) continue;
      DeckGroup& group = deck_.groups[std::size_t(group_index(deck_, name, 0))];
      group.elements = numbers;
      for (const std::int64_t number : numbers) {
        if (const auto point = points_.find(number); point != points_.end()) {
          group.nodes.insert(group.nodes.end(), point->second.begin(), point->second.end());
          continue;
        }
        const auto found = place_of_.find(number);
        if (found == place_of_.end())
          throw Error(fmt::format("element set \"{}\": there is no element {}", name, number));
        std::ranges::copy_if(deck_.elements[found->second].nodes, std::back_inserter(group.nodes),
                             [](std::int64_t node) { return node != 0; });
      }
    }
  }

  std::span<const Keyword> keywords_;
  AbaqusSets sets_;
  Deck deck_;
  struct SectionOfSet {
    std::string set;
    const Keyword* keyword;
    int dimension;
  };
  std::unordered_map<std::int64_t, SectionOfSet> section_of_;  ///< by element
  std::unordered_map<std::int64_t, std::size_t> place_of_;     ///< of elements in the deck
  std::map<std::int64_t, std::vector<std::int64_t>> points_;   ///< nodes of springs and masses
  std::map<std::string, int> left_out_;                        ///< keywords
  std::map<std::string, std::size_t> n_reduced_;               ///< elements by type
};

}  // namespace

Deck abaqus_deck(std::span<const Keyword> keywords)
{
  return AbaqusReader(keywords).read();
}

namespace {

/// Area, second moments and torsion constant of a profile; x along n1, y along n2.
struct ProfileMoments {
  double area, of_x_squared, of_y_squared, J;
  double shear_factor;  ///< as Abaqus has it for this kind of profile
};

ProfileMoments rectangle_moments(double a, double b)
{
  const double l = std::max(a, b), s = std::min(a, b), ratio = s / l;
  const double J = l * s * s * s * (1.0 / 3.0 - 0.21 * ratio * (1.0 - std::pow(ratio, 4) / 12.0));
  return {a * b, b * a * a * a / 12.0, a * b * b * b / 12.0, J, 0.85};
}

ProfileMoments pipe(double outer, double inner, double shear_factor)
{
  const double I = pi / 4.0 * (std::pow(outer, 4) - std::pow(inner, 4));
  return {pi * (outer * outer - inner * inner), I, I, 2.0 * I, shear_factor};
}

/// A thin-walled box: width a along n1, height b, walls t_1 (at the end of n1) to t_4 around it.
ProfileMoments box(const Keyword& section, const KeywordRow& row)
{
  std::array<double, 6> d{};
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = section.real(row, i, "a length of the profile");
  const auto [a, b, t_1, t_2, t_3, t_4] = d;
  if (t_1 != t_3 || t_2 != t_4) {
    section.refuse(
        row, "walls of two thicknesses: the centroid and the shear centre must be in the middle");
  }
  if (!(2.0 * t_1 < a && 2.0 * t_2 < b))
    section.refuse(row, "its walls are thicker than half of it");
  const ProfileMoments outer = rectangle_moments(a, b),
                       inner = rectangle_moments(a - 2.0 * t_1, b - 2.0 * t_2);
  const double w = a - t_1, h = b - t_2;  // between the middles of the walls
  return {outer.area - inner.area, outer.of_x_squared - inner.of_x_squared,
          outer.of_y_squared - inner.of_y_squared, 2.0 * w * w * h * h / (w / t_2 + h / t_1), 0.44};
}

ProfileMoments moments(const Keyword& section, const KeywordRow& row)
{
  const std::string& kind = section.parameter("SECTION");
  const double first = section.real(row, 0, "a length of the profile");
  const bool is_rectangle = kind == "RECT" || kind == "RECTANGULAR";
  if (kind == "CIRC") return pipe(first, 0.0, 0.89);
  if (!is_rectangle && kind != "PIPE" && kind != "BOX")
    section.refuse(fmt::format("the profile {} is not known; RECT, CIRC, PIPE and BOX are", kind));
  const double second = section.real(row, 1, "a length of the profile");
  if (is_rectangle) return rectangle_moments(first, second);
  if (kind == "BOX") return box(section, row);
  if (!(second < first)) section.refuse(row, "the wall of the pipe is thicker than its radius");
  return pipe(first, first - second, 0.53);
}

class AbaqusDeclarer {
 public:
  AbaqusDeclarer(std::span<const Keyword> keywords, const Deck& deck, const DeckUnits& units)
      : model_(abaqus_model(keywords)),
        sets_(abaqus_sets(keywords)),
        deck_(deck),
        units_(units),
        holders_(deck)
  {
    const auto first = std::ranges::find(keywords, "STEP", &Keyword::name);
    for (auto step = first; step != keywords.end(); ++step) {
      if (step == first || step->name != "STEP" || !step->has("PERTURBATION")) continue;
      all_.notes.push_back(fmt::format(
          "{}: *STEP, PERTURBATION: the steps before it load the body, whose vibrations then have "
          "other frequencies; those of the body without loads are found here",
          step->place));
      break;
    }
  }

  Declarations declare()
  {
    for (const Keyword& keyword : model_)
      if (keyword.name == "NODAL THICKNESS") thicknesses(keyword);
    for (std::size_t i = 0; i < model_.size(); ++i) {
      const Keyword& keyword = model_[i];
      if (keyword.name == "MATERIAL") material(i);
      if (keyword.name == "SHELL SECTION") shell(keyword);
      if (keyword.name == "BEAM SECTION" || keyword.name == "BEAM GENERAL SECTION") beam(keyword);
      if (keyword.name == "SOLID SECTION" && has_solids(keyword)) solid(keyword);
    }
    for (const DeclaredMaterial& material : materials_)
      if (material.density > 0.0 || all_.uses(material.name))
        all_.add(material, keyword_of_.at(material.name)->place);
    declare_couplings(deck_, units_, holders_, all_);
    for (const Keyword& keyword : model_)
      if (keyword.name == "BOUNDARY") boundary(keyword);
    for (const AbaqusPoint& point : abaqus_points(model_, sets_)) {
      if (point.type() == "MASS") mass(point);
      if (point.type().starts_with("SPRING")) spring(point);
    }
    for (const AbaqusTruss& one : abaqus_trusses(model_, sets_)) truss(one);
    for (std::size_t g = 0; g < deck_.groups.size(); ++g) {
      const DeckGroup& group = deck_.groups[g];
      if (group.dimension == 0 || all_.has_section(group.name)) continue;
      const auto element = std::ranges::find(deck_.elements, int(g), &DeckElement::group);
      if (element->marks) continue;
      throw Error(fmt::format("{}: *ELEMENT: element {} is of \"{}\", which no section names",
                              element->place, element->number, group.name));
    }
    return std::move(all_);
  }

 private:
  /// What `make` returns; its errors get line and keyword.
  static auto told(const Keyword& keyword, const std::string& place, auto&& make)
  {
    try {
      return make();
    } catch (const Error& error) {
      keyword.refuse({place, {}}, error.what());
    }
  }

  void material(std::size_t at)
  {
    const Keyword& keyword = model_[at];
    DeclaredMaterial material{
        .name = keyword.parameter("NAME"), .young = 0.0, .poisson = 0.0, .density = 0.0};
    bool is_elastic = false;
    for (++at; at < model_.size(); ++at) {
      const Keyword& part = model_[at];
      if (part.name == "ELASTIC") {
        part.expect_only({"TYPE"});
        if (part.has("TYPE") && part.parameter("TYPE").substr(0, 3) != "ISO")
          part.refuse("only TYPE = ISOTROPIC is known");
        const KeywordRow& row = first_temperature(part, 2);
        material.young = part.real(row, 0, "Young's modulus") * units_.stress();
        material.poisson = part.real_or(row, 1, "Poisson's ratio", 0.0);
        is_elastic = true;
      } else if (part.name == "DENSITY") {
        part.expect_only({});
        material.density =
            part.real(first_temperature(part, 1), 0, "the density") * units_.density();
      } else if (part.name != "DAMPING" && !keywords_without_effect().contains(part.name)) {
        break;
      }
    }
    if (!is_elastic) keyword.refuse(fmt::format("{} has no *ELASTIC", material.name));
    materials_.push_back(material);
    keyword_of_[material.name] = &keyword;
  }

  /// Of values at several temperatures, which stand behind them, those of the first count.
  const KeywordRow& first_temperature(const Keyword& part, std::size_t n_values)
  {
    if (part.rows.size() < 2 || Keyword::field(part.rows.front(), n_values).empty())
      return only_row(part);
    all_.notes.push_back(fmt::format("{}: *{} has values for {} temperatures; those at {} count",
                                     part.place, part.name, part.rows.size(),
                                     Keyword::field(part.rows.front(), n_values)));
    return part.rows.front();
  }

  void shell(const Keyword& keyword)
  {
    keyword.expect_only({"ELSET", "MATERIAL", "OFFSET", "ORIENTATION", "SECTION INTEGRATION"});
    const double thickness = keyword.real(only_row(keyword), 0, "the thickness") * units_.length;
    // Abaqus tells where the nodes are, a scene where the middle is.
    double of_thickness = 0.0;
    if (keyword.has("OFFSET")) {
      const std::string& offset = keyword.parameter("OFFSET");
      of_thickness = offset == "SPOS"   ? 0.5
                     : offset == "SNEG" ? -0.5
                                        : keyword.real({keyword.place, {offset}}, 0, "OFFSET");
    }
    all_.shells.push_back({.group = keyword.parameter("ELSET"),
                           .material = keyword.parameter("MATERIAL"),
                           .thickness = thickness,
                           .table = table_of(keyword, thickness),
                           .offset = of_thickness == 0.0 ? 0.0 : -of_thickness * thickness});
  }

  /// Those of *NODAL THICKNESS, of nodes or sets.
  void thicknesses(const Keyword& keyword)
  {
    keyword.expect_only({});
    for (const KeywordRow& row : keyword.rows)
      for (const std::int64_t node : abaqus_nodes(keyword, row, row.fields.front(), sets_))
        thickness_of_[node] = keyword.real(row, 1, "the thickness") * units_.length;
  }

  /// The thicknesses of the nodes of a section as a table over one coordinate.
  /// @param thickness  m, of nodes without one of their own
  std::optional<DeclaredShell::Table> table_of(const Keyword& section, double thickness) const
  {
    std::set<std::int64_t> nodes;
    for (const DeckElement& element : deck_.elements) {
      if (element.group >= 0 &&
          deck_.groups[std::size_t(element.group)].name == section.parameter("ELSET"))
        nodes.insert(element.nodes.begin(), element.nodes.end());
    }
    nodes.erase(0);
    if (std::ranges::none_of(nodes, [&](auto node) { return thickness_of_.contains(node); }))
      return std::nullopt;
    constexpr std::array names{"x", "y", "z", "radius"};
    for (std::size_t c = 0; c < names.size(); ++c) {
      std::map<double, double> table;
      const bool is_function = std::ranges::all_of(nodes, [&](std::int64_t node) {
        const auto found = thickness_of_.find(node);
        const double own = found == thickness_of_.end() ? thickness : found->second;
        const Vector& x = deck_.nodes.at(node);
        // Nodes of one row differ by round-off.
        const double at = (c < 3 ? x[c] : std::hypot(x[0], x[1])) * units_.length;
        constexpr double digits = 1e-6;
        const auto near = table.lower_bound(at - digits * std::abs(at) - 1e-12);
        if (near != table.end() && std::abs(near->first - at) <= digits * std::abs(at) + 1e-12)
          return near->second == own;
        table.emplace(at, own);
        return true;
      });
      if (!is_function) continue;
      DeclaredShell::Table found{.over = names[c], .at = {}, .values = {}};
      for (const auto& [at, value] : table) {
        found.at.push_back(at);
        found.values.push_back(value);
      }
      return found;
    }
    section.refuse(
        "the *NODAL THICKNESS of its nodes is no function of x, y, z or the radius, as a scene has "
        "it; give parts of one thickness sections of their own");
  }

  void mass(const AbaqusPoint& point)
  {
    point.property->expect_only({"ELSET"});
    all_.masses.push_back(
        {.at = holder(point, 0),
         .mass = point.property->real(only_row(*point.property), 0, "the mass") * units_.mass(),
         .inertia = {},
         .offset = {}});
  }

  /// The group of a node, or its name as the reference node of a coupling.
  std::string holder(const AbaqusPoint& point, std::size_t end)
  {
    return told(*point.elements, point.row->place,
                [&] { return *holders_.of(point.group(end), {point.nodes[end]}).begin(); });
  }

  /// Between two nodes along a coordinate axis, or in a component; a node of no element that is
  /// held is the ground.
  void spring(const AbaqusPoint& point)
  {
    const Keyword& property = *point.property;
    property.expect_only({"ELSET"});
    const bool is_axial = point.type() == "SPRINGA";
    if (property.rows.size() != (is_axial ? 1U : 2U)) {
      property.refuse(
          "needs the stiffness on a line, and before it the components of SPRING1 and 2");
    }
    const double k = property.real(property.rows.back(), 0, "the stiffness");
    if (k < 0.0) property.refuse("its stiffness is negative");
    std::size_t component = 0;
    if (is_axial) {
      component = axis_between(deck_, point.nodes).value_or(0);
    } else {
      const KeywordRow& row = property.rows.front();
      const std::int64_t c = property.integer(row, 0, "component");
      if (c > 6 || (point.nodes.size() == 2 && property.integer(row, 1, "component") != c))
        property.refuse(row, "joins two components; a spring of a scene acts in one of 1 to 6");
      component = std::size_t(c) - 1;
    }
    DeclaredSpring spring{.at = point.group(0), .stiffness = {}};
    spring.stiffness[component] =
        k * (component < 3 ? units_.force / units_.length : units_.force * units_.length);
    const auto own = std::ranges::find(deck_.groups, spring.at, &DeckGroup::name);
    if (own->nodes.front() != point.nodes.front()) {  // of an equation
      all_.springs.push_back(spring);
      return;
    }
    for (const std::int64_t node : point.nodes)
      if (!is_axial && deck_.axes.contains(node))
        property.refuse(fmt::format("node {} has a *TRANSFORM", node));
    std::vector<std::size_t> ends;
    for (std::size_t end = 0; end < point.nodes.size(); ++end)
      if (!is_ground(point.nodes[end], int(component))) ends.push_back(end);
    if (ends.empty()) return;
    if (!is_axial && ends.size() == 2 && component < 3 &&
        are_apart_across(deck_, point.nodes, component)) {
      point.elements->refuse(
          *point.row,
          "its nodes are apart across its component, and one belongs to no element; take "
          "nodes at one place or SPRINGA");
    }
    spring.at = holder(point, ends.front());
    if (ends.size() == 2) spring.to = holder(point, ends.back());
    all_.springs.push_back(spring);
  }

  bool is_ground(std::int64_t node, int component) const
  {
    if (holders_.is_in_mesh(node) || holders_.is_reference(node)) return false;
    const auto held = held_.find(node);
    return held != held_.end() && held->second.contains(component);
  }

  /// A spring for the elongation, a mass of half of the bar at each end.
  void truss(const AbaqusTruss& truss)
  {
    const Keyword& section = *truss.section;
    section.expect_only({"ELSET", "MATERIAL"});
    const auto material =
        std::ranges::find(materials_, section.parameter("MATERIAL"), &DeclaredMaterial::name);
    if (material == materials_.end())
      section.refuse(fmt::format("there is no material \"{}\"", section.parameter("MATERIAL")));
    const double area = section.real(only_row(section), 0, "the area") * units_.area();
    const double length =
        norm(minus(deck_.nodes.at(truss.nodes[1]), deck_.nodes.at(truss.nodes[0]))) * units_.length;
    all_.springs.push_back({.at = truss.group(), .stiffness = {material->young * area / length}});
    for (const std::size_t end : {0U, 1U}) {
      if (!(material->density > 0.0)) break;
      const std::string group = fmt::format("{}_{}", truss.group(), end + 1);
      all_.masses.push_back({.at = *holders_.of(group, {truss.nodes[end]}).begin(),
                             .mass = 0.5 * material->density * area * length,
                             .inertia = {},
                             .offset = {}});
    }
  }

  /// Not of trusses alone.
  bool has_solids(const Keyword& section) const
  {
    const auto group =
        std::ranges::find(deck_.groups, section.parameter("ELSET"), &DeckGroup::name);
    return group == deck_.groups.end() || group->dimension > 0;
  }

  void solid(const Keyword& keyword)
  {
    keyword.expect_only({"ELSET", "MATERIAL", "ORIENTATION", "CONTROLS"});
    all_.solids.push_back(
        {.group = keyword.parameter("ELSET"), .material = keyword.parameter("MATERIAL")});
  }

  void beam(const Keyword& keyword)
  {
    keyword.expect_only({"ELSET", "MATERIAL", "SECTION"});
    if (keyword.rows.empty() || keyword.rows.size() > 2)
      keyword.refuse("needs the profile, and its direction n1 on a line of its own");
    const ProfileMoments profile = moments(keyword, keyword.rows.front());
    Vector n1{0.0, 0.0, -1.0};
    if (keyword.rows.size() == 2)
      for (std::size_t c = 0; c < 3; ++c) n1[c] = keyword.real_or(keyword.rows[1], c, "n1", 0.0);
    if (!(norm(n1) > 0.0)) keyword.refuse("its direction n1 is zero");
    all_.beams.push_back({.group = keyword.parameter("ELSET"),
                          .material = keyword.parameter("MATERIAL"),
                          .area = profile.area * units_.area(),
                          .I_y = profile.of_x_squared * units_.second_moment(),
                          .I_z = profile.of_y_squared * units_.second_moment(),
                          .J = profile.J * units_.second_moment(),
                          .shear_factor_y = profile.shear_factor,
                          .shear_factor_z = profile.shear_factor,
                          .orientation = unit(n1)});
  }

  void boundary(const Keyword& keyword)
  {
    keyword.expect_only(
        {"AMPLITUDE", "OP", "FIXED", "TEMPERATURE", "PRESSURE", "MASS FLOW", "MASSFLOW"});
    const auto moves = [&](const KeywordRow& row) {
      return keyword.real_or(row, 3, "a displacement", 0.0) != 0.0;
    };
    const auto moved = std::ranges::find_if(keyword.rows, moves);
    if (moved != keyword.rows.end()) {
      all_.notes.push_back(fmt::format(
          "{}: *BOUNDARY prescribes a displacement; small vibrations have it held at zero",
          moved->place));
    }
    for (const KeywordRow& row : keyword.rows) {
      const std::string& name = row.fields.front();
      if (is_of_no_motion(keyword, row)) continue;
      std::string group =
          keyword.is_integer(name) ? "boundary_" + name : name_of_node_set(name, sets_);
      std::vector<std::int64_t> nodes = abaqus_nodes(keyword, row, name, sets_);
      const std::vector<int> held = held_components(keyword, row);
      for (const std::int64_t node : nodes) held_[node].insert(held.begin(), held.end());
      const std::vector<std::int64_t> others =
          told(keyword, row.place, [&] { return holders_.held_in_basic_axes(deck_, nodes, held); });
      if (others.size() < nodes.size()) {
        all_.notes.push_back(
            fmt::format("{}: *BOUNDARY in axes of *TRANSFORM holds as an equation, "
                        "which the mesh has and the scene does not show",
                        row.place));
        group = name_of_others(row);
        nodes = others;
      }
      const std::vector<std::int64_t> supported =
          supported_nodes(holders_, row.place + ": *BOUNDARY", nodes, all_);
      for (const std::string& holder :
           told(keyword, row.place, [&] { return holders_.of(group, supported); }))
        add_support(all_, holder, held);
    }
  }

  std::span<const Keyword> model_;
  AbaqusSets sets_;
  const Deck& deck_;
  DeckUnits units_;
  Holders holders_;
  std::map<std::int64_t, std::set<int>> held_;   ///< components of nodes
  std::map<std::int64_t, double> thickness_of_;  ///< m, of nodes
  std::vector<DeclaredMaterial> materials_;
  std::map<std::string, const Keyword*> keyword_of_;  ///< by the name of the material
  Declarations all_;
};

}  // namespace

Declarations abaqus_declarations(std::span<const Keyword> keywords, const Deck& deck,
                                 const DeckUnits& units)
{
  return AbaqusDeclarer(keywords, deck, units).declare();
}

namespace {

/// What GENERATE may stand for.
constexpr std::int64_t longest_set = 2'000'000;

void generate_numbers(const Keyword& keyword, const KeywordRow& row,
                      std::vector<std::int64_t>& numbers)
{
  const std::int64_t first = keyword.integer(row, 0, "number"),
                     last = keyword.integer(row, 1, "number");
  const bool has_step = !Keyword::field(row, 2).empty();
  const std::int64_t step = has_step ? keyword.integer(row, 2, "step") : 1;
  if (last < first || last - first > longest_set)
    keyword.refuse(row, fmt::format("{} to {} is no range of numbers", first, last));
  for (std::int64_t n = first; n <= last; n += step) numbers.push_back(n);
}

void add_set_row(const Keyword& keyword, const KeywordRow& row, const std::string& name,
                 std::map<std::string, std::vector<std::int64_t>>& sets)
{
  std::vector<std::int64_t> numbers;
  if (keyword.has("GENERATE")) generate_numbers(keyword, row, numbers);
  for (std::size_t i = 0; i < row.fields.size() && !keyword.has("GENERATE"); ++i) {
    const std::string& field = row.fields[i];
    if (field.empty()) continue;
    if (keyword.is_integer(field)) {
      numbers.push_back(keyword.integer(row, i, "number"));
      continue;
    }
    const auto other = sets.find(field);
    if (other == sets.end()) keyword.refuse(row, fmt::format("there is no set \"{}\"", field));
    if (other->second.size() > longest_set) keyword.refuse(row, "holds too many numbers");
    numbers.insert(numbers.end(), other->second.begin(), other->second.end());
  }
  std::vector<std::int64_t>& set = sets[name];
  set.insert(set.end(), numbers.begin(), numbers.end());
  if (keyword.has("UNSORTED")) {
    if (std::set(set.begin(), set.end()).size() < set.size())
      keyword.refuse(row, "has a node twice, which an UNSORTED set must not");
    return;
  }
  std::ranges::sort(set);
  set.erase(std::unique(set.begin(), set.end()), set.end());
}

/// The numbers of the nodes or elements that a keyword defines.
void add_defined(const Keyword& keyword, std::vector<std::int64_t>& set)
{
  if (keyword.name == "ELEMENT")
    for (const ElementRowOfKeyword& element : elements_in(keyword))
      set.push_back(element.numbers.front());
  else
    for (const KeywordRow& row : keyword.rows) set.push_back(keyword.integer(row, 0, "number"));
}

}  // namespace

std::span<const Keyword> abaqus_model(std::span<const Keyword> keywords)
{
  const auto step = std::ranges::find(keywords, "STEP", &Keyword::name);
  return keywords.first(std::size_t(step - keywords.begin()));
}

AbaqusSets abaqus_sets(std::span<const Keyword> keywords)
{
  AbaqusSets sets;
  for (const Keyword& keyword : abaqus_model(keywords)) {
    if (keyword.name == "NODE" && keyword.has("NSET"))
      add_defined(keyword, sets.nodes[keyword.parameter("NSET")]);
    if (keyword.name == "ELEMENT" && keyword.has("ELSET"))
      add_defined(keyword, sets.elements[keyword.parameter("ELSET")]);
    if (keyword.name == "NSET") {
      keyword.expect_only({"NSET", "GENERATE", "INTERNAL", "UNSORTED"});
      sets.nodes[keyword.parameter("NSET")];
      for (const KeywordRow& row : keyword.rows)
        add_set_row(keyword, row, keyword.parameter("NSET"), sets.nodes);
    }
    if (keyword.name == "ELSET") {
      keyword.expect_only({"ELSET", "GENERATE", "INTERNAL"});
      sets.elements[keyword.parameter("ELSET")];
      for (const KeywordRow& row : keyword.rows)
        add_set_row(keyword, row, keyword.parameter("ELSET"), sets.elements);
    }
  }
  return sets;
}

std::string name_of_node_set(const std::string& set, const AbaqusSets& sets)
{
  return sets.elements.contains(set) ? set + "_nodes" : set;
}

std::vector<std::int64_t> abaqus_nodes(const Keyword& keyword, const KeywordRow& row,
                                       std::string_view name, const AbaqusSets& sets)
{
  if (keyword.is_integer(name))
    return {keyword.integer({row.place, {std::string(name)}}, 0, "node")};
  const auto set = sets.nodes.find(std::string(name));
  if (set == sets.nodes.end())
    keyword.refuse(row, fmt::format("there is no node set \"{}\"", name));
  return set->second;
}

}  // namespace chladni::mesh
