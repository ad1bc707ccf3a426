#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/decks/abaqus.hpp"

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
    if (abaqus_model(keywords_).size() < keywords_.size())
      deck_.notes.emplace_back("steps are left out, with the boundary conditions in them");
    return std::move(deck_);
  }

 private:
  using ReadKeyword = void (Reader::*)(const Keyword&);

  void read(const Keyword& keyword)
  {
    static const std::unordered_map<std::string, ReadKeyword> readers{
        {"NODE", &Reader::nodes},
        {"ELEMENT", &Reader::elements},
        {"SURFACE", &Reader::surface},
        {"BOUNDARY", &Reader::boundary}};
    // Read elsewhere, or nothing to a mesh.
    static const std::set<std::string> known{
        "HEADING", "NSET",    "ELSET",    "SHELL SECTION", "BEAM SECTION", "MATERIAL",
        "ELASTIC", "DENSITY", "COUPLING", "KINEMATIC",     "DISTRIBUTING", "PREPRINT"};
    const auto reader = readers.find(keyword.name);
    if (reader != readers.end()) return (this->*reader->second)(keyword);
    if (known.contains(keyword.name)) return;
    for (const char* part : {"PART", "INSTANCE", "ASSEMBLY"}) {
      if (keyword.name != part) continue;
      keyword.refuse(
          "only flat input files are read; write one, in Abaqus/CAE by "
          "mdb.models[NAME].setValues(noPartsInputFile=ON)");
    }
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

  /// The nodes of shells whose one side or other is meant.
  std::vector<std::int64_t> nodes_of_faces(const Keyword& keyword, const KeywordRow& row) const
  {
    const std::string_view side = Keyword::field(row, 1);
    if (!side.empty() && side != "SPOS" && side != "SNEG")
      keyword.refuse(row, fmt::format("{}: only whole shells, SPOS or SNEG, are known", side));
    const auto set = sets_.elements.find(row.fields.front());
    if (set == sets_.elements.end())
      keyword.refuse(row, fmt::format("there is no element set \"{}\"", row.fields.front()));
    std::vector<std::int64_t> nodes;
    for (const std::int64_t element : set->second) {
      const auto found = nodes_of_.find(element);
      if (found == nodes_of_.end())
        keyword.refuse(row, fmt::format("there is no element {}", element));
      nodes.insert(nodes.end(), found->second.begin(), found->second.end());
    }
    return nodes;
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
