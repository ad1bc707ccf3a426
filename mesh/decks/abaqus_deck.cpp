#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/decks/abaqus.hpp"
#include "mesh/decks/holders.hpp"

namespace chladni::mesh {
namespace {

/// What an element type is, by its number of nodes; lines have two or three.
struct Type {
  Shape shape;
  std::size_t n_nodes;
};

const std::unordered_map<std::string, Type>& types()
{
  static const std::unordered_map<std::string, Type> all{
      {"S3", {Shape::triangle, 3}},      {"S3R", {Shape::triangle, 3}},
      {"S4", {Shape::quadrilateral, 4}}, {"S4R", {Shape::quadrilateral, 4}},
      {"S6", {Shape::triangle, 6}},      {"STRI65", {Shape::triangle, 6}},
      {"S8", {Shape::quadrilateral, 8}}, {"S8R", {Shape::quadrilateral, 8}},
      {"B31", {Shape::line, 2}},         {"B32", {Shape::line, 3}}};
  return all;
}

class Reader {
 public:
  explicit Reader(std::span<const Keyword> keywords)
      : keywords_(keywords), sets_(abaqus_sets(keywords))
  {}

  Deck read()
  {
    find_section_sets();
    for (const Keyword& keyword : abaqus_model(keywords_)) read(keyword);
    add_sets();
    couple();
    note_steps();
    return std::move(deck_);
  }

 private:
  using ReadKeyword = void (Reader::*)(const Keyword&);

  void note_steps()
  {
    const std::size_t n_of_model = abaqus_model(keywords_).size();
    if (n_of_model == keywords_.size()) return;
    deck_.notes.emplace_back("steps are left out, but for the supports of the first one");
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
        {"NODE", &Reader::nodes},
        {"ELEMENT", &Reader::elements},
        {"SURFACE", &Reader::surface},
        {"INSTANCE", &Reader::instance},
        {"BOUNDARY", &Reader::boundary}};
    // Read elsewhere, or nothing to a mesh.
    static const std::set<std::string> known{
        "HEADING", "NSET",    "ELSET",    "SHELL SECTION", "BEAM SECTION", "MATERIAL",
        "ELASTIC", "DENSITY", "COUPLING", "KINEMATIC",     "DISTRIBUTING", "PREPRINT"};
    const auto reader = readers.find(keyword.name);
    if (reader != readers.end()) return (this->*reader->second)(keyword);
    if (known.contains(keyword.name)) return;
    keyword.refuse("this keyword is not known; take it out if the model is the same without it");
  }

  /// Each element is of the group that a section names, or else of its own ELSET.
  void find_section_sets()
  {
    for (const Keyword& keyword : abaqus_model(keywords_)) {
      if (keyword.name != "SHELL SECTION" && keyword.name != "BEAM SECTION") continue;
      const std::string& set = keyword.parameter("ELSET");
      const auto elements = sets_.elements.find(set);
      if (elements == sets_.elements.end())
        keyword.refuse(fmt::format("there is no element set \"{}\"", set));
      for (const std::int64_t element : elements->second)
        if (!section_of_.emplace(element, set).second)
          keyword.refuse(fmt::format("element {} has two sections", element));
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

  static const Type& type_of(const Keyword& keyword)
  {
    const std::string& name = keyword.parameter("TYPE");
    const auto type = types().find(name);
    if (type != types().end()) return type->second;
    if (name.starts_with("C3D")) {
      keyword.refuse(fmt::format(
          "{} is a solid element; Chladni has shells and beams: mesh the mid-surface with S3, S4R "
          "or S8R, or reduce the solids in the program that they come from",
          name));
    }
    keyword.refuse(fmt::format(
        "{} is not known; S3, S3R, S4, S4R, S6, STRI65, S8, S8R, B31 and B32 are", name));
  }

  void elements(const Keyword& keyword)
  {
    keyword.expect_only({"TYPE", "ELSET"});
    const Type& type = type_of(keyword);
    std::vector<std::int64_t> numbers;
    for (const KeywordRow& row : keyword.rows) {
      for (std::size_t i = 0; i < row.fields.size(); ++i)
        if (!row.fields[i].empty()) numbers.push_back(keyword.integer(row, i, "number"));
      if (row.fields.back().empty()) continue;  // goes on
      if (numbers.size() != type.n_nodes + 1) {
        keyword.refuse(row, fmt::format("{} numbers instead of that of the element and of {} nodes",
                                        numbers.size(), type.n_nodes));
      }
      add_element(keyword, row, type, numbers);
      numbers.clear();
    }
    if (!numbers.empty()) keyword.refuse("its last element ends with a comma");
  }

  void add_element(const Keyword& keyword, const KeywordRow& row, const Type& type,
                   const std::vector<std::int64_t>& numbers)
  {
    const std::int64_t number = numbers.front();
    const std::vector<std::int64_t> nodes(numbers.begin() + 1, numbers.end());
    if (!nodes_of_.emplace(number, nodes).second)
      keyword.refuse(row, fmt::format("element {} is there twice", number));
    const auto section = section_of_.find(number);
    const std::string name = section != section_of_.end() ? section->second
                             : keyword.has("ELSET")       ? keyword.parameter("ELSET")
                                                          : "ELEMENTS";
    const bool is_line = type.shape == Shape::line;
    const int group = group_index(deck_, name, is_line ? 1 : 2);
    if (deck_.groups[std::size_t(group)].dimension != (is_line ? 1 : 2))
      keyword.refuse(row, fmt::format("\"{}\" holds shells and beams", name));
    if (is_line) {
      deck_.elements.push_back({.number = number,
                                .shape = Shape::line,
                                .order = static_cast<int>(nodes.size()) - 1,
                                .nodes = nodes,
                                .group = group});
    } else {
      deck_.elements.push_back(surface_element(number, nodes, group));
    }
    deck_.elements.back().place = row.place;
  }

  void surface(const Keyword& keyword)
  {
    keyword.expect_only({"NAME", "TYPE", "INTERNAL"});
    const std::string name = fmt::format("surface_{}", keyword.parameter("NAME"));
    const bool is_of_nodes = keyword.has("TYPE") && keyword.parameter("TYPE") == "NODE";
    std::vector<std::int64_t>& all = deck_.groups[std::size_t(group_index(deck_, name, 0))].nodes;
    for (const KeywordRow& row : keyword.rows) {
      const std::string& set = row.fields.front();
      const std::vector<std::int64_t> found =
          is_of_nodes ? abaqus_nodes(keyword, row, set, sets_) : nodes_of_faces(keyword, row);
      all.insert(all.end(), found.begin(), found.end());
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

  /// The nodes of shells whose one side or other is meant, or one of whose edges, E1 and so on.
  std::vector<std::int64_t> nodes_of_faces(const Keyword& keyword, const KeywordRow& row) const
  {
    const std::string_view side = Keyword::field(row, 1);
    const bool is_edge = side.size() == 2 && side[0] == 'E' && side[1] >= '1' && side[1] <= '4';
    if (!side.empty() && side != "SPOS" && side != "SNEG" && !is_edge) {
      keyword.refuse(row, fmt::format("{}: only sides of shells, SPOS or SNEG, and their edges, E1 "
                                      "to E4, are known",
                                      side));
    }
    std::vector<std::int64_t> nodes;
    for (const std::int64_t element : elements_of(keyword, row)) {
      const auto found = nodes_of_.find(element);
      if (found == nodes_of_.end())
        keyword.refuse(row, fmt::format("there is no element {}", element));
      const std::vector<std::int64_t> of_edge =
          is_edge ? nodes_of_edge(found->second, std::size_t(side[1] - '1')) : found->second;
      if (of_edge.empty())
        keyword.refuse(row, fmt::format("element {} has no edge {}", element, side));
      nodes.insert(nodes.end(), of_edge.begin(), of_edge.end());
    }
    return nodes;
  }

  /// @param nodes  of a shell, corners first, then the middles of the edges
  static std::vector<std::int64_t> nodes_of_edge(const std::vector<std::int64_t>& nodes,
                                                 std::size_t edge)
  {
    const bool has_middles = nodes.size() > 4;
    const std::size_t n_corners = has_middles ? nodes.size() / 2 : nodes.size();
    if (edge >= n_corners) return {};
    std::vector<std::int64_t> found{nodes[edge], nodes[(edge + 1) % n_corners]};
    if (has_middles) found.push_back(nodes[n_corners + edge]);
    return found;
  }

  /// Couplings, whose kind stands in the keyword behind.
  void couple()
  {
    const std::span<const Keyword> model = abaqus_model(keywords_);
    for (std::size_t i = 0; i < model.size(); ++i)
      if (model[i].name == "COUPLING")
        coupling(model[i], i + 1 < model.size() ? &model[i + 1] : nullptr);
    add_leaders(deck_);
  }

  void coupling(const Keyword& keyword, const Keyword* kind)
  {
    keyword.expect_only({"CONSTRAINT NAME", "REF NODE", "SURFACE"});
    const bool averages = kind != nullptr && kind->name == "DISTRIBUTING";
    if (kind == nullptr || (!averages && kind->name != "KINEMATIC"))
      keyword.refuse("has neither *KINEMATIC nor *DISTRIBUTING behind it");
    kind->expect_only(averages ? std::set<std::string>{"WEIGHTING METHOD"}
                               : std::set<std::string>{});
    check_components(*kind);
    const std::vector<std::int64_t> nodes =
        abaqus_nodes(keyword, {keyword.place, {}}, keyword.parameter("REF NODE"), sets_);
    if (nodes.size() != 1) keyword.refuse("its reference is not one node");
    const std::string group = "surface_" + keyword.parameter("SURFACE");
    if (std::ranges::find(deck_.groups, group, &DeckGroup::name) == deck_.groups.end())
      keyword.refuse(fmt::format("there is no surface \"{}\"", keyword.parameter("SURFACE")));
    deck_.couplings.push_back({.entry = fmt::format("{}: *COUPLING", keyword.place),
                               .reference = nodes.front(),
                               .group = group,
                               .averages = averages});
  }

  /// All six, which need no data line.
  static void check_components(const Keyword& kind)
  {
    std::vector<bool> found(6, kind.rows.empty());
    for (const KeywordRow& row : kind.rows) {
      const std::int64_t first = kind.integer(row, 0, "component");
      const bool is_one = Keyword::field(row, 1).empty();
      const std::int64_t last = is_one ? first : kind.integer(row, 1, "component");
      for (std::int64_t c = first; c <= std::min<std::int64_t>(last, 6); ++c)
        found[std::size_t(c) - 1] = true;
    }
    if (std::ranges::find(found, false) != found.end())
      kind.refuse("couples not all components 1 to 6; a scene's coupling does");
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
      const int group = group_index(deck_, name_of_node_set(name, sets_), 0);
      deck_.groups[std::size_t(group)].nodes = numbers;
    }
    for (const auto& [name, numbers] : sets_.elements) {
      const auto is_used = std::ranges::find(deck_.groups, name, &DeckGroup::name);
      if (is_used != deck_.groups.end() && is_used->dimension > 0) continue;
      std::vector<std::int64_t>& nodes =
          deck_.groups[std::size_t(group_index(deck_, name, 0))].nodes;
      for (const std::int64_t element : numbers) {
        const auto found = nodes_of_.find(element);
        if (found == nodes_of_.end())
          throw Error(fmt::format("element set \"{}\": there is no element {}", name, element));
        nodes.insert(nodes.end(), found->second.begin(), found->second.end());
      }
    }
  }

  std::span<const Keyword> keywords_;
  AbaqusSets sets_;
  Deck deck_;
  std::unordered_map<std::int64_t, std::string> section_of_;
  std::unordered_map<std::int64_t, std::vector<std::int64_t>> nodes_of_;  ///< by element
};

}  // namespace

Deck abaqus_deck(std::span<const Keyword> keywords)
{
  return Reader(keywords).read();
}

}  // namespace chladni::mesh
