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
#include "mesh/mesh.hpp"

namespace chladni::mesh {

using std::numbers::pi;

namespace {

/// What an element type is, by its number of nodes; lines have two or three.
struct AbaqusType {
  Shape shape;
  std::size_t n_nodes;
};

const std::unordered_map<std::string, AbaqusType>& abaqus_types()
{
  static const std::unordered_map<std::string, AbaqusType> all{
      {"S3", {Shape::triangle, 3}},      {"S3R", {Shape::triangle, 3}},
      {"S4", {Shape::quadrilateral, 4}}, {"S4R", {Shape::quadrilateral, 4}},
      {"S6", {Shape::triangle, 6}},      {"STRI65", {Shape::triangle, 6}},
      {"S8", {Shape::quadrilateral, 8}}, {"S8R", {Shape::quadrilateral, 8}},
      {"B31", {Shape::line, 2}},         {"B32", {Shape::line, 3}}};
  return all;
}

class AbaqusReader {
 public:
  explicit AbaqusReader(std::span<const Keyword> keywords)
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
  using ReadKeyword = void (AbaqusReader::*)(const Keyword&);

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
        {"NODE", &AbaqusReader::nodes},
        {"ELEMENT", &AbaqusReader::elements},
        {"SURFACE", &AbaqusReader::surface},
        {"INSTANCE", &AbaqusReader::instance},
        {"BOUNDARY", &AbaqusReader::boundary}};
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

  static const AbaqusType& type_of(const Keyword& keyword)
  {
    const std::string& name = keyword.parameter("TYPE");
    const auto type = abaqus_types().find(name);
    if (type != abaqus_types().end()) return type->second;
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
    const AbaqusType& type = type_of(keyword);
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

  void add_element(const Keyword& keyword, const KeywordRow& row, const AbaqusType& type,
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

ProfileMoments moments(const Keyword& section, const KeywordRow& row)
{
  const std::string& kind = section.parameter("SECTION");
  const double first = section.real(row, 0, "a length of the profile");
  if (kind == "CIRC") return pipe(first, 0.0, 0.89);
  if (kind != "RECT" && kind != "PIPE")
    section.refuse(fmt::format("the profile {} is not known; RECT, CIRC and PIPE are", kind));
  const double second = section.real(row, 1, "a length of the profile");
  if (kind == "RECT") return rectangle_moments(first, second);
  if (!(second < first)) section.refuse(row, "the wall of the pipe is thicker than its radius");
  return pipe(first, first - second, 0.53);
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

class AbaqusDeclarer {
 public:
  AbaqusDeclarer(std::span<const Keyword> keywords, const Deck& deck, const DeckUnits& units)
      : model_(abaqus_model(keywords)), sets_(abaqus_sets(keywords)), units_(units), holders_(deck)
  {}

  Declarations declare(const Deck& deck)
  {
    for (std::size_t i = 0; i < model_.size(); ++i) {
      const Keyword& keyword = model_[i];
      if (keyword.name == "MATERIAL") material(i);
      if (keyword.name == "SHELL SECTION") shell(keyword);
      if (keyword.name == "BEAM SECTION") beam(keyword);
    }
    check_densities();
    declare_couplings(deck, units_, holders_, all_);
    for (const Keyword& keyword : model_)
      if (keyword.name == "BOUNDARY") boundary(keyword);
    for (std::size_t g = 0; g < deck.groups.size(); ++g) {
      const DeckGroup& group = deck.groups[g];
      const bool is_there =
          std::ranges::find(all_.shells, group.name, &DeclaredShell::group) != all_.shells.end() ||
          std::ranges::find(all_.beams, group.name, &DeclaredBeam::group) != all_.beams.end();
      if (group.dimension == 0 || is_there) continue;
      const auto element = std::ranges::find(deck.elements, int(g), &DeckElement::group);
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
        material.young = part.real(only_row(part), 0, "Young's modulus") * units_.stress();
        material.poisson = part.real_or(only_row(part), 1, "Poisson's ratio", 0.0);
        is_elastic = true;
      } else if (part.name == "DENSITY") {
        part.expect_only({});
        material.density = part.real(only_row(part), 0, "the density") * units_.density();
      } else {
        break;
      }
    }
    if (!is_elastic) keyword.refuse(fmt::format("{} has no *ELASTIC", material.name));
    all_.materials.push_back(material);
    keyword_of_[material.name] = &keyword;
  }

  /// Materials without a density are no error as long as no element is of them.
  void check_densities()
  {
    std::erase_if(all_.materials, [&](const DeclaredMaterial& material) {
      if (material.density > 0.0) return false;
      const auto is_of_it = [&](const auto& section) { return section.material == material.name; };
      if (std::ranges::any_of(all_.shells, is_of_it) || std::ranges::any_of(all_.beams, is_of_it)) {
        keyword_of_.at(material.name)
            ->refuse(fmt::format("{} has no *DENSITY, without which there are no natural "
                                 "frequencies; give it one, "
                                 "a small one to what is to have no mass",
                                 material.name));
      }
      return true;
    });
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
                           .offset = of_thickness == 0.0 ? 0.0 : -of_thickness * thickness});
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

  static std::vector<int> components(const Keyword& keyword, const KeywordRow& row)
  {
    if (const auto named = components_named(Keyword::field(row, 1))) return *named;
    const std::int64_t first = keyword.integer(row, 1, "component");
    const bool is_one = Keyword::field(row, 2).empty();
    const std::int64_t last = is_one ? first : keyword.integer(row, 2, "component");
    if (first > last || last > 6)
      keyword.refuse(row, fmt::format("{} to {} are no components of 1 to 6", first, last));
    if (keyword.real_or(row, 3, "a displacement", 0.0) != 0.0)
      keyword.refuse(row, "prescribes a displacement; a scene's support holds at zero only");
    std::vector<int> held;
    for (std::int64_t c = first; c <= last; ++c) held.push_back(static_cast<int>(c) - 1);
    return held;
  }

  void boundary(const Keyword& keyword)
  {
    keyword.expect_only({});
    for (const KeywordRow& row : keyword.rows) {
      const std::string& name = row.fields.front();
      const std::string group =
          keyword.is_integer(name) ? "boundary_" + name : name_of_node_set(name, sets_);
      const std::vector<std::int64_t> nodes = abaqus_nodes(keyword, row, name, sets_);
      const std::vector<int> held = components(keyword, row);
      const std::vector<std::int64_t> supported =
          supported_nodes(holders_, row.place + ": *BOUNDARY", nodes, all_);
      for (const std::string& holder :
           told(keyword, row.place, [&] { return holders_.of(group, supported); }))
        add_support(all_, holder, held);
    }
  }

  std::span<const Keyword> model_;
  AbaqusSets sets_;
  DeckUnits units_;
  Holders holders_;
  std::map<std::string, const Keyword*> keyword_of_;  ///< by the name of the material
  Declarations all_;
};

}  // namespace

Declarations abaqus_declarations(std::span<const Keyword> keywords, const Deck& deck,
                                 const DeckUnits& units)
{
  return AbaqusDeclarer(keywords, deck, units).declare(deck);
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
  std::ranges::sort(set);
  set.erase(std::unique(set.begin(), set.end()), set.end());
}

/// The numbers of the nodes or elements that a keyword defines; an element goes over several lines
/// where one ends with a comma.
void add_defined(const Keyword& keyword, std::vector<std::int64_t>& set)
{
  bool goes_on = false;
  for (const KeywordRow& row : keyword.rows) {
    if (!goes_on) set.push_back(keyword.integer(row, 0, "number"));
    goes_on = keyword.name == "ELEMENT" && row.fields.back().empty();
  }
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
