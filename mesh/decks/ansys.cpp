// The blocks are those that Ansys' manual describes under CDWRITE. A row of EBLOCK begins with
// material, element type, real constants, section, coordinate system, four numbers about the solid
// model, of which the last is the number of nodes, one that is not used, and the number of the
// element.

#include "mesh/decks/ansys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/error.hpp"
#include "mesh/decks/file_elements.hpp"
#include "mesh/element_types.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

namespace {

/// A collapsed form of an element: which corners are one, what it stands for, and where its nodes
/// are.
struct CollapsedForm {
  Shape shape;
  std::vector<int> corners;  ///< for each corner the first one with its node
  Shape becomes;
  std::vector<int> places;
};

const std::vector<CollapsedForm>& collapsed_forms()
{
  static const std::vector<CollapsedForm> all{
      {Shape::quadrilateral, {0, 1, 2, 2}, Shape::triangle, {0, 1, 2, 4, 5, 7}},
      {Shape::hexahedron,
       {0, 1, 2, 2, 4, 5, 6, 6},
       Shape::wedge,
       {0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18}},
      {Shape::hexahedron,
       {0, 1, 2, 2, 4, 4, 4, 4},
       Shape::tetrahedron,
       {0, 1, 2, 4, 8, 9, 11, 16, 17, 18}}};
  return all;
}

/// For each corner the first one with its node.
std::vector<int> first_alike(const std::vector<std::int64_t>& nodes, std::size_t n_corners)
{
  std::vector<int> first;
  for (std::size_t i = 0; i < n_corners; ++i)
    first.push_back(int(std::ranges::find(nodes, nodes[i]) - nodes.begin()));
  return first;
}

bool is_collapsed(const std::vector<int>& first_alike)
{
  for (std::size_t i = 0; i < first_alike.size(); ++i)
    if (first_alike[i] != int(i)) return true;
  return false;
}

/// What an element type of the archive is.
struct AnsysType {
  std::int64_t number = 0;                       ///< 186 of SOLID186
  std::map<std::int64_t, std::int64_t> options;  ///< KEYOPT
};

/// A mass at a node, or a spring between two.
struct PointElement {
  std::string place;
  std::int64_t number, type, constants;
  std::vector<std::int64_t> nodes;

  std::string group(std::size_t end) const
  {
    return type == 21 ? fmt::format("mass21_{}", number)
                      : fmt::format("combin14_{}_{}", number, end + 1);
  }
};

/// A section of shells.
struct AnsysSection {
  std::string place;
  bool is_shell = false;
  int n_layers = 0;
  double thickness = 0.0;
  std::int64_t material = 0;  ///< 0: that of the element
  std::string offset = "MID";
};

constexpr std::array degrees{"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};

/// Everything that an archive says, in its own units.
class AnsysReader {
 public:
  AnsysReader(const std::string& text, const ReadIncluded& read)
      : lines_(text, no_file_of_ansys, read), commands_(ansys_commands(lines_))
  {
    for (const AnsysCommand& command : commands_) take(command);
    add_held();
    add_missing_middles(deck_);
    if (!left_out_.empty()) {
      std::vector<std::string> names;
      constexpr std::size_t most = 12;
      for (const auto& [name, n] : left_out_)
        if (names.size() < most) names.push_back(name);
      if (left_out_.size() > most)
        names.push_back(fmt::format("and {} others", left_out_.size() - most));
      deck_.notes.push_back(fmt::format("commands that are no part of a mesh are left out: {}",
                                        fmt::join(names, ", ")));
    }
    for (const auto& [type, n] : n_surfaces_) {
      deck_.notes.push_back(
          fmt::format("{} elements of surface effects (type {}) are left out", n, type));
    }
  }

  const Deck& deck() const { return deck_; }

  Declarations declarations(const DeckUnits& units) const;

 private:
  using ReadCommand = void (AnsysReader::*)(const AnsysCommand&);

  void take(const AnsysCommand& command)
  {
    static const std::map<std::string, ReadCommand> readers{
        {"NBLOCK", &AnsysReader::nodes},      {"EBLOCK", &AnsysReader::elements},
        {"CMBLOCK", &AnsysReader::component}, {"ET", &AnsysReader::type},
        {"ETBLOCK", &AnsysReader::types},     {"KEYOPT", &AnsysReader::option},
        {"KEYOP", &AnsysReader::option},      {"KEYO", &AnsysReader::option},
        {"R", &AnsysReader::constants},       {"RLBLOCK", &AnsysReader::blocks_of_constants},
        {"MP", &AnsysReader::property},       {"MPDATA", &AnsysReader::table_of_property},
        {"SECTYPE", &AnsysReader::section},   {"SECDATA", &AnsysReader::layer},
        {"SECOFFSET", &AnsysReader::offset},  {"SECBLOCK", &AnsysReader::layers},
        {"D", &AnsysReader::support}};
    static const std::set<std::string> refused{"CE",     "CP",     "CERIG",  "RBE3",  "CEINTF",
                                               "CPINTF", "EN",     "E",      "EMORE", "*DO",
                                               "RMORE",  "/INPUT", "CDREAD", "NROTAT"};
    const auto reader = readers.find(command.name());
    if (reader != readers.end()) return (this->*reader->second)(command);
    if (refused.contains(command.name())) {
      command.refuse(
          "is not read, and the model would be another one without it; write the archive anew with "
          "CDWRITE, without couplings between nodes");
    }
    const bool ends_nodes = command.name() == "N" && command.word(3) == "-1";
    if (command.name() == "N" && !ends_nodes) command.refuse("write the nodes as a block, NBLOCK");
    if (!ends_nodes) ++left_out_[command.name()];
  }

  void nodes(const AnsysCommand& command)
  {
    const AnsysColumns columns(command);
    for (const DeckLine& row : command.rows) {
      const std::vector<std::int64_t> numbers = columns.whole(row);
      if (!numbers.empty() && numbers[0] == -1) break;
      if (numbers.empty() || numbers[0] < 1) command.refuse(row, "has no number of a node");
      std::vector<double> x = columns.real(row);
      x.resize(6, 0.0);
      if (x[3] != 0.0 || x[4] != 0.0 || x[5] != 0.0) turned_.insert(numbers[0]);
      if (!deck_.nodes.emplace(numbers[0], std::array{x[0], x[1], x[2]}).second)
        command.refuse(row, fmt::format("node {} is there twice", numbers[0]));
    }
  }

  void type(const AnsysCommand& command)
  {
    last_type_ = command.whole(1, "number of a type");
    AnsysType& type = types_[last_type_];
    type = {};
    const std::string_view name = command.word(2);
    const std::size_t digit = std::min(name.find_first_of("0123456789"), name.size());
    const auto number = number_of_ansys<std::int64_t>(name.substr(digit));
    if (!number) command.refuse(fmt::format("\"{}\" is no element type, such as 186", name));
    type.number = *number;
    for (std::size_t i = 3; i < command.words.size(); ++i)
      if (!command.words[i].empty()) type.options[std::int64_t(i) - 2] = command.whole(i, "option");
  }

  void types(const AnsysCommand& command)
  {
    const AnsysColumns columns(command);
    for (const DeckLine& row : command.rows) {
      const std::vector<std::int64_t> numbers = columns.whole(row);
      if (numbers.empty() || numbers[0] == -1) break;
      if (numbers.size() < 2) command.refuse(row, "has no element type");
      AnsysType& type = types_[numbers[0]];
      type = {.number = numbers[1], .options = {}};
      const std::vector<std::string> words = words_of(row.text);
      for (std::size_t i = 2; i < words.size(); ++i)
        if (const auto value = number_of_ansys<std::int64_t>(words[i]))
          type.options[std::int64_t(i) - 1] = *value;
    }
  }

  void option(const AnsysCommand& command)
  {
    types_[command.whole(1, "number of a type")].options[command.whole(2, "number of an option")] =
        command.whole_or(3, "option", 0);
  }

  static bool is_surface_effect(std::int64_t type)
  {
    constexpr std::int64_t first = 151, last = 156, mesh = 200;
    return (type >= first && type <= last) || type == mesh;
  }

  /// Mechanical writes surface effects and contact so, of the type that it defined last.
  void leave_out_block(const AnsysCommand& command)
  {
    const auto type = types_.find(last_type_);
    const std::int64_t number = type == types_.end() ? 0 : type->second.number;
    if (!is_surface_effect(number)) {
      command.refuse(
          fmt::format("a block without SOLID, of the type {}; only surface effects (151 to 156) "
                      "are passed over, "
                      "contact is not read: write the archive anew with CDWRITE, without contact",
                      number));
    }
    n_surfaces_[number] += int(command.rows.size());
  }

  void elements(const AnsysCommand& command)
  {
    if (command.word(2) != "SOLID") return leave_out_block(command);
    constexpr std::size_t n_head = 11, in_first_row = 8;
    const AnsysColumns columns(command);
    for (std::size_t i = 0; i < command.rows.size(); ++i) {
      const DeckLine& row = command.rows[i];
      std::vector<std::int64_t> numbers = columns.whole(row);
      if (numbers.empty() || numbers[0] == -1) break;
      if (numbers.size() < n_head) {
        command.refuse(row, fmt::format("{} numbers are no element, which has {} and its nodes",
                                        numbers.size(), n_head));
      }
      const auto n_nodes = numbers[8];
      if (n_nodes > std::int64_t(in_first_row) && i + 1 < command.rows.size()) {
        const std::vector<std::int64_t> more = columns.whole(command.rows[++i]);
        numbers.insert(numbers.end(), more.begin(), more.end());
      }
      if (std::int64_t(numbers.size()) < std::int64_t(n_head) + n_nodes || n_nodes < 1) {
        command.refuse(row, fmt::format("element {} has {} nodes instead of {}", numbers[10],
                                        numbers.size() - n_head, n_nodes));
      }
      numbers.resize(n_head + std::size_t(n_nodes));
      add_element(command, row, numbers);
    }
  }

  void add_element(const AnsysCommand& command, const DeckLine& row,
                   const std::vector<std::int64_t>& numbers)
  {
    const std::int64_t number = numbers[10];
    const auto found = types_.find(numbers[1]);
    if (found == types_.end()) {
      command.refuse(row, fmt::format("element {} is of the type {}, which no ET defines", number,
                                      numbers[1]));
    }
    const std::int64_t type = found->second.number;
    const std::vector<std::int64_t> nodes(numbers.begin() + 11, numbers.end());
    if (!place_of_.emplace(number, deck_.elements.size()).second)
      command.refuse(row, fmt::format("element {} is there twice", number));
    constexpr std::int64_t mass = 21, spring = 14;
    if (type == mass || type == spring) {
      place_of_.erase(number);
      return add_point(command, {.place = row.place,
                                 .number = number,
                                 .type = type,
                                 .constants = numbers[2],
                                 .nodes = nodes});
    }
    if (is_surface_effect(type)) {
      place_of_.erase(number);
      ++n_surfaces_[type];
      return;
    }
    const std::vector<FileElement>& types = file_elements(Format::ansys, fmt::format("{}", type));
    if (types.empty()) {
      command.refuse(row,
                     fmt::format("element {} is of the type {}, which is not known; {}, 21 (mass) "
                                 "and 14 (spring) are",
                                 number, type, names_of_elements(Format::ansys)));
    }
    add_known(command, row, types.front(), numbers);
  }

  void add_known(const AnsysCommand& command, const DeckLine& row, const FileElement& type,
                 const std::vector<std::int64_t>& numbers)
  {
    const std::int64_t number = numbers[10];
    std::vector<std::int64_t> nodes(numbers.begin() + 11, numbers.end());
    const auto n = std::size_t(n_corners(type.shape));
    if (nodes.size() < n || nodes.size() > type.n_nodes) {
      command.refuse(row, fmt::format("element {} has {} nodes; its type has {}", number,
                                      nodes.size(), type.n_nodes));
    }
    nodes.resize(type.n_nodes, 0);
    const bool is_shell = is_surface(type.shape);
    const int group =
        group_index(deck_, is_shell ? name_of_section(numbers[3]) : name_of_material(numbers[0]),
                    dimension(type.shape));
    if (is_shell) material_of_[number] = numbers[0];
    const FileElement* kind = &type;
    if (const std::vector<int> corners = first_alike(nodes, n); is_collapsed(corners)) {
      const auto form = std::ranges::find_if(collapsed_forms(), [&](const CollapsedForm& each) {
        return each.shape == type.shape && each.corners == corners;
      });
      if (form == collapsed_forms().end()) {
        command.refuse(row,
                       fmt::format("element {} has a node at several corners, and is neither a "
                                   "wedge nor a tetrahedron (a pyramid?): {}",
                                   number, "mesh the volume there with tetrahedra"));
      }
      std::vector<std::int64_t> of_form;
      kind = &file_element(Format::ansys, form->becomes, type.order);
      for (std::size_t i = 0; i < kind->n_nodes; ++i)
        of_form.push_back(nodes[std::size_t(form->places[i])]);
      nodes = std::move(of_form);
    }
    deck_.elements.push_back(deck_element(*kind, number, nodes, group));
    deck_.elements.back().place = row.place;
  }

  void add_point(const AnsysCommand& command, PointElement point)
  {
    const std::size_t n = point.type == 21 ? 1 : 2;
    if (point.nodes.size() < n)
      command.refuse(fmt::format("element {} has {} nodes", point.number, point.nodes.size()));
    point.nodes.resize(n);
    for (std::size_t end = 0; end < n; ++end)
      deck_.groups[std::size_t(group_index(deck_, point.group(end), 0))].nodes = {point.nodes[end]};
    points_.push_back(std::move(point));
  }

  static std::string name_of_material(std::int64_t number) { return fmt::format("mat_{}", number); }
  static std::string name_of_section(std::int64_t number) { return fmt::format("sec_{}", number); }

  void component(const AnsysCommand& command)
  {
    const AnsysColumns columns(command);
    std::vector<std::int64_t> members;
    for (const DeckLine& row : command.rows) {
      for (const std::int64_t number : columns.whole(row)) {
        if (number > 0) {
          members.push_back(number);
          continue;
        }
        if (members.empty() || -number < members.back())
          command.refuse(row, fmt::format("{} ends no range of numbers", number));
        for (std::int64_t next = members.back() + 1; next <= -number; ++next)
          members.push_back(next);
      }
    }
    const std::string name(command.word(1));
    DeckGroup& group = deck_.groups[std::size_t(group_index(deck_, name, 0))];
    components_[name] = {};
    if (command.word(2).starts_with("NODE")) {
      std::erase_if(members, [&](std::int64_t node) { return !deck_.nodes.contains(node); });
      group.nodes = members;
      components_[name] = members;
      return;
    }
    group.elements = members;
    for (const std::int64_t number : members) {
      const auto element = place_of_.find(number);
      if (element == place_of_.end()) continue;
      std::ranges::copy_if(deck_.elements[element->second].nodes, std::back_inserter(group.nodes),
                           [](std::int64_t node) { return node != 0; });
    }
  }

  void constants(const AnsysCommand& command)
  {
    std::vector<double>& values = constants_[command.whole(1, "number of real constants")];
    for (std::size_t i = 2; i < command.words.size(); ++i)
      values.push_back(command.real_or_zero(i, "a real constant"));
  }

  void blocks_of_constants(const AnsysCommand& command)
  {
    constexpr std::int64_t in_first_row = 6, in_further_rows = 7;
    const AnsysColumns columns(command);
    for (std::size_t i = 0; i < command.rows.size(); ++i) {
      const std::vector<std::int64_t> head = columns.whole(command.rows[i]);
      if (head.size() != 2) command.refuse(command.rows[i], "has no number of real constants");
      constants_[head[0]] = columns.real(command.rows[i]);
      const std::int64_t more = std::max<std::int64_t>(0, head[1] - in_first_row);
      i += std::size_t((more + in_further_rows - 1) / in_further_rows);
    }
  }

  void property(const AnsysCommand& command)
  {
    for (std::size_t i = 4; i < command.words.size(); ++i)
      if (command.real_or_zero(i, "a coefficient") != 0.0)
        command.refuse("depends on temperature; a scene's material does not");
    set_property(command, {std::string(command.word(1)), command.whole(2, "number of a material")},
                 command.real(3, "a property"));
  }

  /// MPDATA,R5.0,n,EX,material,start,value, ... or without the first two.
  void table_of_property(const AnsysCommand& command)
  {
    const bool has_head = command.word(1).starts_with("R5") || command.word(1) == "UNBL";
    const std::size_t at = has_head ? 3 : 1;
    const std::pair key{std::string(command.word(at)),
                        command.whole(at + 1, "number of a material")};
    for (std::size_t i = at + 3; i < command.words.size(); ++i)
      if (!command.words[i].empty()) set_property(command, key, command.real(i, "a property"));
  }

  void set_property(const AnsysCommand& command, const std::pair<std::string, std::int64_t>& key,
                    double value)
  {
    const auto [found, is_new] = properties_.emplace(key, value);
    if (!is_new && found->second != value) {
      command.refuse(
          fmt::format("{} of material {} has several values; a scene's material does not "
                      "depend on temperature",
                      key.first, key.second));
    }
    places_of_materials_.emplace(key.second, command.place);
  }

  void section(const AnsysCommand& command)
  {
    current_section_ = command.whole(1, "number of a section");
    sections_[current_section_] = {.place = command.place,
                                   .is_shell = command.word(2).starts_with("SHEL")};
  }

  void add_layer(double thickness, std::int64_t material)
  {
    AnsysSection& section = sections_[current_section_];
    ++section.n_layers;
    section.thickness = thickness;
    section.material = material;
  }

  void layer(const AnsysCommand& command)
  {
    if (sections_[current_section_].is_shell)
      add_layer(command.real(1, "a thickness"), command.whole_or(2, "material", 0));
  }

  void layers(const AnsysCommand& command)
  {
    for (const DeckLine& row : command.rows) {
      AnsysCommand of_row = command;
      of_row.words = cut_at_commas(row.text);
      if (sections_[current_section_].is_shell)
        add_layer(of_row.real(0, "a thickness"), of_row.whole_or(1, "material", 0));
    }
  }

  void offset(const AnsysCommand& command) { sections_[current_section_].offset = command.word(1); }

  /// D, node or component, label, value, value2, last node, step, more labels.
  void support(const AnsysCommand& command)
  {
    std::set<int> held;
    for (const std::size_t i : {2, 7, 8, 9, 10, 11}) {
      const std::string_view label = command.word(i);
      if (label.empty()) continue;
      const auto degree = std::ranges::find(degrees, label);
      if (label != "ALL" && degree == degrees.end())
        command.refuse(fmt::format("{} is none of UX, UY, UZ, ROTX, ROTY, ROTZ and ALL", label));
      for (int c = 0; c < 6; ++c)
        if (label == "ALL" || degrees[std::size_t(c)] == label) held.insert(c);
    }
    if (command.real_or_zero(3, "a displacement") != 0.0)
      command.refuse("prescribes a displacement; a scene's support holds at zero only");
    for (const std::int64_t node : nodes_of(command)) {
      if (turned_.contains(node) && held.size() < 3) {
        command.refuse(
            fmt::format("node {} has axes of its own; only the global ones are known", node));
      }
      held_[node].insert(held.begin(), held.end());
    }
  }

  std::vector<std::int64_t> nodes_of(const AnsysCommand& command) const
  {
    const auto component = components_.find(std::string(command.word(1)));
    if (component != components_.end()) return component->second;
    if (command.word(1) == "ALL")
      command.refuse("holds a selection of nodes; name a component instead");
    const std::int64_t first = command.whole(1, "node or component");
    const std::int64_t last = command.whole_or(5, "node", first),
                       step = std::max<std::int64_t>(1, command.whole_or(6, "step", 1));
    std::vector<std::int64_t> nodes;
    for (auto node = deck_.nodes.lower_bound(first);
         node != deck_.nodes.end() && node->first <= last; ++node)
      if ((node->first - first) % step == 0) nodes.push_back(node->first);
    if (nodes.empty()) command.refuse(fmt::format("there is no node {}", first));
    return nodes;
  }

  static std::string name_of_held(const std::set<int>& components)
  {
    std::string digits;
    for (const int c : components) digits += char('1' + c);
    return "d_" + digits;
  }

  void add_held()
  {
    for (const auto& [node, components] : held_) {
      deck_.groups[std::size_t(group_index(deck_, name_of_held(components), 0))].nodes.push_back(
          node);
    }
  }

  void check_material(std::int64_t number, const DeckElement& element) const
  {
    if (places_of_materials_.contains(number)) return;
    throw Error(fmt::format("{} is of the material {}, whose EX neither MP nor MPDATA gives",
                            name_of(element), number));
  }
  void declare_materials(const DeckUnits& units, Declarations& all) const;
  void declare_sections(const DeckUnits& units, Declarations& all) const;
  void declare_points(const DeckUnits& units, const Holders& holders, Declarations& all) const;
  DeclaredMass mass(const DeckUnits& units, const PointElement& point, const std::string& at) const;
  std::size_t component_of_spring(const PointElement& point) const;
  const std::vector<double>& constants_of(const PointElement& point) const;
  std::int64_t option_of(std::int64_t type, std::int64_t option) const;

  DeckLines lines_;
  std::vector<AnsysCommand> commands_;
  Deck deck_;
  std::map<std::int64_t, AnsysType> types_;
  std::int64_t last_type_ = 0;
  std::map<std::int64_t, std::size_t> place_of_;                 ///< of elements in the deck
  std::map<std::int64_t, std::int64_t> material_of_;             ///< of shells
  std::map<std::string, std::vector<std::int64_t>> components_;  ///< nodes
  std::map<std::int64_t, std::vector<double>> constants_;
  std::map<std::pair<std::string, std::int64_t>, double> properties_;  ///< by label and material
  std::map<std::int64_t, std::string> places_of_materials_;
  std::map<std::int64_t, AnsysSection> sections_;
  std::int64_t current_section_ = 0;
  std::vector<PointElement> points_;
  std::set<std::int64_t> turned_;
  std::map<std::int64_t, std::set<int>> held_;
  std::map<std::string, int> left_out_;
  std::map<std::int64_t, int> n_surfaces_;
};

void AnsysReader::declare_materials(const DeckUnits& units, Declarations& all) const
{
  for (const auto& entry : places_of_materials_) {
    const std::int64_t number = entry.first;
    const std::string& place = entry.second;
    const std::string name = name_of_material(number);
    if (!all.uses(name)) continue;
    const auto refuse = [&](const std::string& why) {
      throw Error(fmt::format("{}: material {}: {}", place, number, why));
    };
    const auto value = [&](const char* label) -> std::optional<double> {
      const auto found = properties_.find({label, number});
      return found == properties_.end() ? std::nullopt : std::optional(found->second);
    };
    const auto E = value("EX"), rho = value("DENS");
    const auto nu = value("PRXY") ? value("PRXY") : value("NUXY");
    if (!E) refuse("has no modulus EX");
    const double poisson = nu.value_or(0.3);  // as in Ansys
    const auto check = [&](const char* label, double expected) {
      constexpr double digits = 1e-3;
      if (const auto given = value(label);
          given && std::abs(*given - expected) > digits * expected) {
        refuse(fmt::format("{} = {:.6g} is not {:.6g}; a scene's materials are isotropic", label,
                           *given, expected));
      }
    };
    for (const char* label : {"EY", "EZ"}) check(label, *E);
    for (const char* label : {"PRYZ", "PRXZ", "NUYZ", "NUXZ"}) check(label, poisson);
    for (const char* label : {"GXY", "GYZ", "GXZ"}) check(label, *E / (2.0 * (1.0 + poisson)));
    all.add({.name = name,
             .young = *E * units.stress(),
             .poisson = poisson,
             .density = rho.value_or(0.0) * units.density()},
            place);
  }
}

void AnsysReader::declare_sections(const DeckUnits& units, Declarations& all) const
{
  for (std::size_t g = 0; g < deck_.groups.size(); ++g) {
    const DeckGroup& group = deck_.groups[g];
    if (group.dimension < 2) continue;
    const auto number = *number_of_ansys<std::int64_t>(group.name.substr(4));
    const auto first = std::ranges::find(deck_.elements, int(g), &DeckElement::group);
    if (group.dimension == 3) {
      check_material(number, *first);
      all.solids.push_back({.group = group.name, .material = group.name});
      continue;
    }
    const auto found = sections_.find(number);
    if (found == sections_.end() || found->second.n_layers != 1) {
      throw Error(
          fmt::format("{}: the section {} of element {} {}", first->place, number, first->number,
                      found == sections_.end() ? "is not there: give it by SECTYPE and SECDATA"
                                               : "has not one layer, as a scene's shells have"));
    }
    const AnsysSection& section = found->second;
    std::int64_t material = section.material;
    for (const DeckElement& element : deck_.elements) {
      if (element.group != int(g) || section.material != 0) continue;
      const std::int64_t own = material_of_.at(element.number);
      if (material != 0 && own != material) {
        throw Error(
            fmt::format("{}: elements of the section {} are of the materials {} and {}; give each "
                        "a section",
                        element.place, number, material, own));
      }
      material = own;
    }
    const double thickness = section.thickness * units.length;
    if (section.offset != "MID" && section.offset != "TOP" && section.offset != "BOT") {
      throw Error(fmt::format("{}: SECOFFSET {} is not known; MID, TOP and BOT are", section.place,
                              section.offset));
    }
    // Ansys tells where the nodes are, a scene where the middle is.
    const double offset = section.offset == "TOP" ? -0.5 : section.offset == "BOT" ? 0.5 : 0.0;
    check_material(material, *first);
    all.shells.push_back({.group = group.name,
                          .material = name_of_material(material),
                          .thickness = thickness,
                          .offset = offset * thickness});
  }
}

const std::vector<double>& AnsysReader::constants_of(const PointElement& point) const
{
  const auto found = constants_.find(point.constants);
  if (found != constants_.end() && !found->second.empty()) return found->second;
  throw Error(fmt::format("{}: element {}: there are no real constants {}", point.place,
                          point.number, point.constants));
}

std::int64_t AnsysReader::option_of(std::int64_t type, std::int64_t option) const
{
  for (const auto& [number, known] : types_) {
    if (known.number != type) continue;
    const auto found = known.options.find(option);
    return found == known.options.end() ? 0 : found->second;
  }
  return 0;
}

/// KEYOPT(3): 0 has six constants, of displacements and rotations, 2 one mass.
DeclaredMass AnsysReader::mass(const DeckUnits& units, const PointElement& point,
                               const std::string& at) const
{
  std::vector<double> m = constants_of(point);
  const std::int64_t option = option_of(21, 3);
  if (option != 0 && option != 2) {
    throw Error(fmt::format("{}: MASS21 with KEYOPT(3) = {} is not read; 0 and 2 are", point.place,
                            option));
  }
  m.resize(6, 0.0);
  if (option == 0 && (m[1] != m[0] || m[2] != m[0])) {
    throw Error(fmt::format("{}: MASS21 {} differs along x, y and z; a scene's mass does not",
                            point.place, point.number));
  }
  DeclaredMass mass{.at = at, .mass = m[0] * units.mass(), .inertia = {}, .offset = {}};
  for (std::size_t c = 0; c < 3 && option == 0; ++c)
    mass.inertia[c] = m[3 + c] * units.moment_of_inertia();
  return mass;
}

/// KEYOPT(2) names a component; 0 is a spring along its line, which must be an axis here.
std::size_t AnsysReader::component_of_spring(const PointElement& point) const
{
  const std::int64_t option = option_of(14, 2);
  if (option >= 1 && option <= 6) return std::size_t(option - 1);
  if (option == 0 && option_of(14, 3) == 0) {
    const auto a = deck_.nodes.find(point.nodes[0]), b = deck_.nodes.find(point.nodes[1]);
    if (a != deck_.nodes.end() && b != deck_.nodes.end()) {
      const Vector along = minus(b->second, a->second);
      for (std::size_t c = 0; c < 3; ++c)
        if (std::abs(along[c]) > 0.0 && std::abs(along[c]) > (1.0 - 1e-9) * norm(along)) return c;
    }
  }
  throw Error(
      fmt::format("{}: COMBIN14 {} acts neither along an axis nor by KEYOPT(2) = 1 to 6, as a "
                  "scene's spring does",
                  point.place, point.number));
}

void AnsysReader::declare_points(const DeckUnits& units, const Holders& holders,
                                 Declarations& all) const
{
  for (const PointElement& point : points_) {
    const auto holder = [&](std::size_t end) {
      try {
        return *holders.of(point.group(end), {point.nodes[end]}).begin();
      } catch (const Error& error) {
        throw Error(fmt::format("{}: element {}: {}", point.place, point.number, error.what()));
      }
    };
    if (point.type == 21) {
      all.masses.push_back(mass(units, point, holder(0)));
      continue;
    }
    const std::vector<double>& k = constants_of(point);
    if (k.size() > 1 && k[1] != 0.0) {
      throw Error(fmt::format("{}: the damping of COMBIN14 {} is not read; give it in the scene",
                              point.place, point.number));
    }
    const std::size_t c = component_of_spring(point);
    DeclaredSpring spring{.at = holder(0), .to = holder(1), .stiffness = {}};
    spring.stiffness[c] = k[0] * (c < 3 ? units.force / units.length : units.force * units.length);
    all.springs.push_back(std::move(spring));
  }
}

Declarations AnsysReader::declarations(const DeckUnits& units) const
{
  Declarations all;
  const Holders holders(deck_);
  declare_sections(units, all);
  declare_materials(units, all);
  for (const auto& [node, components] : held_) {
    const std::string group = name_of_held(components);
    for (const std::string& holder : holders.of(
             group, supported_nodes(holders, fmt::format("D of node {}", node), {node}, all)))
      add_support(all, holder, {components.begin(), components.end()});
  }
  declare_points(units, holders, all);
  return all;
}

}  // namespace

Deck ansys_deck(const std::string& text, const ReadIncluded& read)
{
  return AnsysReader(text, read).deck();
}

Declarations ansys_declarations(const std::string& text, const ReadIncluded& read,
                                const DeckUnits& units)
{
  return AnsysReader(text, read).declarations(units);
}

}  // namespace chladni::mesh
