#include "mesh/decks/nastran.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/decks/deck.hpp"
#include "mesh/decks/file_elements.hpp"
#include "mesh/mesh.hpp"

namespace chladni::mesh {

namespace {

constexpr const char* no_offset =
    "the element stands off its nodes; a scene has one `offset` for each section";
constexpr const char* no_own_thickness =
    "a thickness of its own; a scene has it in the section, as a table or a formula";

constexpr const char* no_laminate =
    "is a laminate, and a scene's shells are of one isotropic material; take a PSHELL, or the "
    "matrices of the program (mesh.matrices)";
constexpr const char* not_isotropic =
    "is not isotropic, as a scene's materials are; take a MAT1, or the matrices of the program "
    "(mesh.matrices)";

/// What is known, and cannot be a part of a scene.
constexpr std::pair<const char*, const char*> refused_by_name[] = {
    {"PCOMP", no_laminate},
    {"PCOMPG", no_laminate},
    {"MAT2", not_isotropic},
    {"MAT3", not_isotropic},
    {"MAT8", not_isotropic},
    {"MAT9", not_isotropic},
    {"MAT10", "is a fluid, and a scene's bodies are solid; take the fluid out"},
    {"CELAS3", "joins scalar points, and a scene has none; take CELAS1 or CELAS2 between grids"},
    {"CELAS4", "joins scalar points, and a scene has none; take CELAS1 or CELAS2 between grids"},
    {"DMIG",
     "is a matrix beside the elements; `chladni import` reads a superelement of DMIG alone "
     "from a .pch or .dmig"},
    {"RBE1", "is no plain rigid body; take RBE2"},
    {"CGAP", "is a contact, and a scene is linear; take it out or join the nodes"}};

/// Of what becomes of the deck, by card.
class NastranReader {
 public:
  explicit NastranReader(std::span<const Card> cards)
      : cards_(cards), systems_(nastran_systems(cards))
  {}

  Deck read()
  {
    // What lists nodes by ranges means those that there are.
    for (const Card& card : cards_)
      if (card.name() == "GRID") grid(card);
    for (const Card& card : cards_) {
      if (card.name() == "GRID") continue;
      const auto known = readers().find(card.name());
      if (known != readers().end())
        known->second(*this, card);
      else
        refuse_unknown(card);
    }
    part_beams();
    couple();
    hold_in_axes();
    add_missing_middles(deck_);
    for (const auto& [name, n] : left_out_)
      deck_.notes.push_back(fmt::format("{} {} are left out: they are no part of a mesh", n, name));
    return std::move(deck_);
  }

 private:
  using ReadCard = std::function<void(NastranReader&, const Card&)>;
  using Readers = std::unordered_map<std::string, ReadCard>;

  /// Every card that is known. Sections and materials are `nastran_declarations`'.
  static const Readers& readers()
  {
    static const Readers all = make_readers();
    return all;
  }

  static Readers make_readers()
  {
    Readers all{{"SET1", &NastranReader::set1},     {"SPC", &NastranReader::held},
                {"SPC1", &NastranReader::held},     {"PARAM", &NastranReader::parameter},
                {"CONM2", &NastranReader::mass},    {"CELAS1", &NastranReader::spring},
                {"CELAS2", &NastranReader::spring}, {"CBUSH", &NastranReader::spring}};
    for (const char* name : {"RBE2", "RBE3", "RBAR"}) all.emplace(name, &NastranReader::rigid);
    for (const char* name : {"CTETRA", "CPENTA", "CHEXA"}) all.emplace(name, &NastranReader::solid);
    for (const char* name : {"CQUAD4", "CTRIA3"}) all.emplace(name, &NastranReader::flat_shell);
    for (const char* name : {"CQUAD8", "CTRIA6"}) all.emplace(name, &NastranReader::curved_shell);
    for (const char* name : {"CROD", "CONROD"}) {
      all.emplace(name,
                  [](NastranReader& reader, const Card& card) { reader.element_number(card); });
    }
    for (const char* name : {"CBAR", "CBEAM"}) all.emplace(name, &NastranReader::beam);
    for (const char* name : {"PBAR", "PBARL", "PBEAM"})
      all.emplace(name, &NastranReader::property_of_beams);
    for (const char* name : {"ASET", "ASET1"}) all.emplace(name, &NastranReader::analysis_set);
    for (const char* name :
         {"CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S", "MAT1", "PSHELL", "PSOLID",
          "PELAS", "PBUSH", "PROD", "CASE", "GRDSET", "SPCADD", "MPC", "MPCADD"})
      all.emplace(name, [](NastranReader&, const Card&) {});
    for (const char* name :
         {"EIGR",    "EIGRL",   "EIGB",    "EIGC",  "EIGP",   "FORCE",   "MOMENT",  "PLOAD",
          "PLOAD1",  "PLOAD2",  "PLOAD4",  "GRAV",  "RFORCE", "LOAD",    "DLOAD",   "RLOAD1",
          "RLOAD2",  "TLOAD1",  "TLOAD2",  "DAREA", "DELAY",  "DPHASE",  "TABLED1", "TABLED2",
          "TABLED3", "TABLED4", "TABDMP1", "FREQ",  "FREQ1",  "FREQ2",   "FREQ3",   "FREQ4",
          "TSTEP",   "NLPARM",  "TEMP",    "TEMPD", "SUPORT", "SUPORT1", "PLOTEL",  "SPOINT",
          "QSET",    "QSET1",   "OMIT",    "OMIT1", "SPCD"})
      all.emplace(name,
                  [](NastranReader& reader, const Card& card) { ++reader.left_out_[card.name()]; });
    return all;
  }

  [[noreturn]] static void refuse_unknown(const Card& card)
  {
    for (const char* name : {"CPYRAM", "CHEXA8", "CHEXA20"})
      if (card.name() == name) card.refuse(no_such_solid);
    for (const auto& [name, why] : refused_by_name)
      if (card.name() == name) card.refuse(why);
    card.refuse("this card is not known; take it out if the model is the same without it");
  }

  void grid(const Card& card)
  {
    card.expect_no_more_than(8);
    const std::int64_t number = node(card, 1), system = card.integer_or(2, "CP", 0);
    const auto found = systems_.find(system);
    if (found == systems_.end())
      card.refuse(fmt::format("there is no coordinate system {}", system));
    const auto x = basic_position(found->second, card.vector_or_zero(3, "a coordinate"));
    if (!deck_.nodes.emplace(number, x).second) card.refuse("is there twice");
    const auto own = systems_.find(card.integer_or(6, "CD", 0));
    if (own == systems_.end())
      card.refuse(fmt::format("there is no coordinate system {}", card.field(6)));
    if (own->first != 0) deck_.axes[number] = axes_at(own->second, x);
    const std::vector<int> held = held_by_grid(card);
    if (!held.empty())
      add_to(name_of_held_by_grid(held), held_in_basic_axes(deck_, {number}, held));
  }

  /// Supports in the systems CD of nodes are equations.
  void hold_in_axes()
  {
    if (deck_.axes.empty()) return;
    const NodesOfDeck known(deck_);
    const std::set<std::int64_t> chosen = chosen_sets(cards_, "SPC").sets;
    for (const Card& card : cards_) {
      const std::string entry = fmt::format("{}: {} {}", card.place(), card.name(), card.field(1));
      if (card.name() == "GRID")
        mesh::hold_in_axes(deck_, known, {entry, {card.integer(1, "ID")}, held_by_grid(card)});
      if (card.name() != "SPC" && card.name() != "SPC1") continue;
      for (const HeldNodes& held : held_nodes(card, deck_))
        if (chosen.contains(held.set))
          mesh::hold_in_axes(deck_, known, {entry, held.nodes, held.components});
    }
  }

  static std::int64_t node(const Card& card, std::size_t i)
  {
    const std::int64_t number = card.integer(i, "number of a node");
    if (number == 0) card.refuse(fmt::format("field {} needs the number of a node", i + 1));
    return number;
  }

  static std::vector<std::int64_t> nodes(const Card& card, std::size_t n)
  {
    std::vector<std::int64_t> numbers;
    for (std::size_t i = 0; i < n; ++i) numbers.push_back(node(card, 3 + i));
    return numbers;
  }

  void add_to(const std::string& group, const std::vector<std::int64_t>& numbers)
  {
    if (numbers.empty()) return;
    std::vector<std::int64_t>& all =
        deck_.groups[static_cast<std::size_t>(group_index(deck_, group, 0))].nodes;
    all.insert(all.end(), numbers.begin(), numbers.end());
  }

  /// Numbers of shells and beams, of rigid elements, of masses and of springs are their own.
  std::int64_t element_number(const Card& card)
  {
    const std::string kind = card.name().starts_with('R')       ? "rigid"
                             : card.name().starts_with("CELAS") ? "spring"
                             : card.name() == "CONM2"           ? "mass"
                                                                : "solid, shell or beam";
    const std::int64_t number = card.integer(1, "EID");
    if (number == 0 || !element_numbers_.emplace(kind, number).second)
      card.refuse("its number is that of another element, or 0");
    return number;
  }

  int property_group(const Card& card, const char* kind, int dimension)
  {
    const std::int64_t property = card.integer_or(2, "PID", card.integer(1, "EID"));
    return group_index(deck_, fmt::format("{}_{}", kind, property), dimension);
  }

  /// @param first  field behind the nodes: THETA, and ZOFFS behind it
  static void check_shell(const Card& card, std::size_t first, std::size_t thicknesses,
                          std::size_t n_nodes)
  {
    if (card.real_or(first + 1, "ZOFFS", 0.0) != 0.0) card.refuse(no_offset);
    card.expect_blank(thicknesses, thicknesses + n_nodes - 1, no_own_thickness);
  }

  void flat_shell(const Card& card)
  {
    const std::size_t n = card.name() == "CQUAD4" ? 4 : 3;
    // CQUAD4: EID PID G1 G2 G3 G4 THETA ZOFFS, blank TFLAG T1 ..; CTRIA3: EID PID G1 G2 G3 THETA
    // ZOFFS, 3 blank, TFLAG T1 ..
    check_shell(card, 3 + n, 11, n);
    card.expect_no_more_than(10 + n);
    add_surface(card, nodes(card, n));
  }

  /// Of what stands behind the corners a card may leave out any.
  void add_element(const Card& card, const std::vector<std::int64_t>& of_card, const char* property)
  {
    const std::vector<FileElement>& types = file_elements(Format::nastran, card.name());
    const auto type = std::ranges::find(types, of_card.size(), &FileElement::n_nodes);
    deck_.elements.push_back(deck_element(*type, element_number(card), of_card,
                                          property_group(card, property, dimension(type->shape))));
    deck_.elements.back().place = card.place();
  }

  void add_surface(const Card& card, const std::vector<std::int64_t>& of_card)
  {
    add_element(card, of_card, "pshell");
  }

  /// EID PID G1 .. : corners, then the nodes in the middle of edges, or none of these.
  void solid(const Card& card)
  {
    const std::vector<FileElement>& types = file_elements(Format::nastran, card.name());
    const std::size_t n_corners = types.front().n_nodes, n_all = types.back().n_nodes;
    card.expect_no_more_than(2 + n_all);
    std::vector<std::int64_t> of_card = nodes(card, n_corners);
    for (std::size_t i = n_corners; i < n_all; ++i)
      of_card.push_back(card.integer_or(3 + i, "number of a node", 0));
    const bool has_middles = std::any_of(of_card.begin() + std::ptrdiff_t(n_corners), of_card.end(),
                                         [](std::int64_t node) { return node != 0; });
    if (!has_middles) of_card.resize(n_corners);
    add_element(card, of_card, "psolid");
  }

  void curved_shell(const Card& card)
  {
    const bool is_triangle = card.name() == "CTRIA6";
    const std::size_t n = is_triangle ? 6 : 8;
    // CQUAD8: .. G8, T1 .. T4, THETA ZOFFS; CTRIA6: .. G6, THETA ZOFFS T1 T2 T3
    const std::size_t theta = is_triangle ? 9 : 15;
    check_shell(card, theta, 11, is_triangle ? 3 : 4);
    card.expect_no_more_than(is_triangle ? 14 : 17);
    // Of the nodes in the middle of edges a card may leave out any.
    std::vector<std::int64_t> of_card = nodes(card, n / 2);
    for (std::size_t i = n / 2; i < n; ++i)
      of_card.push_back(card.integer_or(3 + i, "number of a node", 0));
    add_surface(card, of_card);
  }

  void beam(const Card& card)
  {
    card.expect_blank(9, 10, "released components have no counterpart in a scene");
    for (std::size_t i = 11; i <= 16; ++i)
      if (card.real_or(i, "an offset", 0.0) != 0.0) card.refuse(no_offset);
    card.expect_no_more_than(16);
    add_element(card, nodes(card, 2), card.name() == "CBAR" ? "pbar" : "pbeam");
    beams_.emplace_back(&card, deck_.elements.size() - 1);
  }

  /// Beams of a property whose vectors differ get groups of their own, "pbar_5_2" and so on, unless
  /// the section is the same about all axes.
  void part_beams()
  {
    constexpr double written = 1e-4;
    std::map<int, std::vector<std::pair<Vector, int>>> parts;  // by group: vectors and groups
    for (const auto& [card, element] : beams_) {
      int& group = deck_.elements[element].group;
      const std::string name = deck_.groups[std::size_t(group)].name;
      if (round_properties_.contains(name)) continue;
      const Vector own = vector_of_beam(*card, deck_);
      auto& of_group = parts[group];
      const auto part = std::ranges::find_if(
          of_group, [&](const auto& of) { return norm(minus(of.first, own)) <= written; });
      if (part == of_group.end()) {
        const int first = group;
        if (!of_group.empty())
          group = group_index(deck_, fmt::format("{}_{}", name, of_group.size() + 1), 1);
        parts[first].emplace_back(own, group);
      } else {
        group = part->second;
      }
    }
  }

  /// Properties whose second moments and shear factors are one about all axes.
  void property_of_beams(const Card& card)
  {
    const bool is_listed = card.name() == "PBARL";
    const bool is_round = is_listed ? card.field(4) != "BAR"
                                    : card.real_or(4, "I1", 0.0) == card.real_or(5, "I2", 0.0) &&
                                          card.field(17) == card.field(18);
    if (is_round) {
      round_properties_.insert(
          fmt::format("{}_{}", card.name() == "PBEAM" ? "pbeam" : "pbar", card.integer(1, "PID")));
    }
  }

  void rigid(const Card& card) { element_number(card); }

  void couple()
  {
    const NodesOfDeck known(deck_);
    for (const RigidElement& element : rigid_elements(cards_, deck_)) {
      if (element.is_of_equations()) {
        add_equations(element, known);
        continue;
      }
      add_to(element.group, element.nodes);
      deck_.couplings.push_back({.entry = fmt::format("{}: {} {}", element.card->place(),
                                                      element.card->name(), element.card->field(1)),
                                 .reference = element.reference,
                                 .group = element.group,
                                 .averages = element.averages()});
    }
    for (const DeckEquation& equation : equations_of_cards(cards_, deck_))
      deck_.equations.push_back(equation);
    for (const Card& card : cards_) {
      if (!is_rod(card)) continue;
      const auto ends = nodes_of_rod(card);
      mesh::add_elongation(deck_, known,
                           {fmt::format("{}: {} {}", card.place(), card.name(), card.field(1)),
                            name_of_rod(card, 0), ends});
      for (const int end : {1, 2}) add_to(name_of_rod(card, end), {ends[std::size_t(end) - 1]});
    }
    add_leaders(deck_);
  }

  void add_equations(const RigidElement& element, const NodesOfDeck& known)
  {
    const std::string entry = fmt::format("{}: {} {}", element.card->place(), element.card->name(),
                                          element.card->field(1));
    if (element.averages()) {
      return add_mean_equations(deck_, entry, element.reference, element.components,
                                element.weights);
    }
    for (const std::int64_t node : element.nodes)
      for (const int c : element.components)
        if (c < 3 || known.rotating.contains(node))
          add_rigid_equations(deck_, entry, element.reference, node, {c});
  }

  void mass(const Card& card)
  {
    element_number(card);
    add_to(name_of_mass(card), {node(card, 2)});
  }

  void spring(const Card& card)
  {
    element_number(card);
    const auto ends = nodes_of_spring(card);
    for (const int i : {0, 1})
      if (ends[std::size_t(i)] != 0) add_to(name_of_spring(card, i + 1), {ends[std::size_t(i)]});
  }

  void held(const Card& card)
  {
    for (const HeldNodes& of_card : held_nodes(card, deck_)) {
      add_to(name_of_held(of_card.set, of_card.components),
             held_in_basic_axes(deck_, of_card.nodes, of_card.components));
    }
  }

  void set1(const Card& card)
  {
    add_to(fmt::format("set_{}", card.integer(1, "SID")), listed_nodes(card, 2, deck_));
  }

  /// WTMASS is a factor of the masses that are declared.
  void parameter(const Card& card)
  {
    if (card.field(1) != "WTMASS") ++left_out_[card.name()];
  }

  /// The nodes that the deck keeps in a reduction: what `interface.nodes` may name.
  void analysis_set(const Card& card)
  {
    if (card.name() == "ASET1") return add_to("aset", listed_nodes(card, 2, deck_));
    for (std::size_t i = 1; i <= card.n_fields(); i += 2)
      if (card.has(i)) add_to("aset", {card.integer(i, "number of a node")});
  }

  std::span<const Card> cards_;
  DeckSystems systems_;
  Deck deck_;
  std::vector<std::pair<const Card*, std::size_t>> beams_;  ///< and their places in the deck
  std::set<std::string> round_properties_;
  std::set<std::pair<std::string, std::int64_t>> element_numbers_;
  std::map<std::string, int> left_out_;
};

}  // namespace

Deck nastran_deck(std::span<const Card> cards)
{
  return NastranReader(cards).read();
}

namespace {

// Of DeckSystem::kind.
constexpr char rectangular = 'R', cylindrical = 'C', spherical = 'S';

/// Three points, by coordinates (CORD2R, C, S) or as grids (CORD1R, C, S, two to a card).
struct SystemOfCard {
  const Card* card;
  std::size_t first;  ///< field of its number

  bool is_by_grids() const { return card->name().starts_with("CORD1"); }
};

bool is_system(const Card& card)
{
  const std::string& name = card.name();
  return name.size() == 6 && (name.starts_with("CORD1") || name.starts_with("CORD2")) &&
         (name[5] == rectangular || name[5] == cylindrical || name[5] == spherical);
}

/// Systems that are found one after the other, each after the one that it refers to.
class Finder {
 public:
  explicit Finder(std::span<const Card> cards)
  {
    found_[0] = {.origin = {}, .axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .kind = rectangular};
    for (const Card& card : cards) {
      if (card.name() == "GRID") grids_.emplace(card.integer(1, "number of a node"), &card);
      if (!is_system(card)) continue;
      add({.card = &card, .first = 1});
      if (card.name().starts_with("CORD1") && card.has(5)) add({.card = &card, .first = 5});
    }
  }

  DeckSystems all()
  {
    for (const auto& [number, of_card] : cards_) {
      if (number == 0) of_card.card->refuse("0 is the basic system");
      find(number, *of_card.card);
    }
    return found_;
  }

 private:
  void find(std::int64_t number, const Card& asking)
  {
    if (found_.contains(number)) return;
    const auto card = cards_.find(number);
    if (card == cards_.end())
      asking.refuse(fmt::format("there is no coordinate system {}", number));
    const SystemOfCard& asked = card->second;
    if (!under_way_.insert(number).second) asked.card->refuse("refers to itself");
    std::array<Vector, 3> points{};
    for (std::size_t i = 0; i < 3; ++i) {
      points[i] = asked.is_by_grids() ? grid(*asked.card, asked.first + 1 + i)
                                      : point(*asked.card, 3 + 3 * i);
    }
    found_[number] = made(*asked.card, points);
  }

  void add(const SystemOfCard& of_card)
  {
    of_card.card->expect_no_more_than(of_card.is_by_grids() ? 8 : 11);
    const std::int64_t number = of_card.card->integer(of_card.first, "CID");
    if (!cards_.emplace(number, of_card).second)
      of_card.card->refuse(fmt::format("there are two systems {}", number));
  }

  Vector point(const Card& card, std::size_t first)
  {
    const std::int64_t reference = card.integer_or(2, "RID", 0);
    find(reference, card);
    return basic_position(found_[reference], card.vector_or_zero(first, "a point"));
  }

  /// Its own system may be one that is still to be found.
  Vector grid(const Card& card, std::size_t field)
  {
    const auto found = grids_.find(card.integer(field, "number of a node"));
    if (found == grids_.end()) card.refuse(fmt::format("there is no GRID {}", card.field(field)));
    const std::int64_t system = found->second->integer_or(2, "CP", 0);
    find(system, *found->second);
    return basic_position(found_[system], found->second->vector_or_zero(3, "a coordinate"));
  }

  /// A, the origin; B on the z axis; C in the x-z plane.
  static DeckSystem made(const Card& card, const std::array<Vector, 3>& points)
  {
    const Vector& A = points[0];
    const Vector z = minus(points[1], A), in_plane = minus(points[2], A);
    const Vector y = cross(z, in_plane);
    if (!(norm(y) > 1e-9 * norm(z) * norm(in_plane)))
      card.refuse("its three points are on one line");
    return {.origin = A, .axes = {unit(cross(y, z)), unit(y), unit(z)}, .kind = card.name().back()};
  }

  std::map<std::int64_t, SystemOfCard> cards_;
  std::unordered_map<std::int64_t, const Card*> grids_;
  std::set<std::int64_t> under_way_;
  DeckSystems found_;
};

}  // namespace

DeckSystems nastran_systems(std::span<const Card> cards)
{
  return Finder(cards).all();
}

std::array<double, 3> basic_position(const DeckSystem& system, const std::array<double, 3>& x)
{
  Vector local = x;
  constexpr double degree = std::numbers::pi / 180.0;
  if (system.kind == cylindrical) {
    const double theta = x[1] * degree;
    local = {x[0] * std::cos(theta), x[0] * std::sin(theta), x[2]};
  }
  if (system.kind == spherical) {  // theta from the z axis, phi about it
    const double theta = x[1] * degree, phi = x[2] * degree, r = x[0] * std::sin(theta);
    local = {r * std::cos(phi), r * std::sin(phi), x[0] * std::cos(theta)};
  }
  Vector position = system.origin;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t c = 0; c < 3; ++c) position[c] += local[axis] * system.axes[axis][c];
  return position;
}

DeckAxes axes_at(const DeckSystem& system, const std::array<double, 3>& x)
{
  if (system.kind == rectangular) return system.axes;
  const Vector& z = system.axes[2];
  const Vector arm = minus(x, system.origin);
  Vector radial = arm;
  for (std::size_t c = 0; c < 3; ++c) radial[c] -= dot(arm, z) * z[c];
  if (norm(radial) <= 1e-9 * norm(arm) || norm(arm) == 0.0) return system.axes;  // on the axis
  radial = unit(radial);
  const Vector around = cross(z, radial);
  if (system.kind == cylindrical) return {radial, around, z};
  const Vector out = unit(arm);
  return {out, cross(around, out), around};
}

namespace {

std::string digits(const std::vector<int>& components)
{
  std::string text;
  for (const int c : components) text += static_cast<char>('1' + c);
  return text;
}

std::string name_of_rigid(const char* kind, const Card& card)
{
  return fmt::format("{}_{}", kind, card.integer(1, "EID"));
}

RigidElement rbe2(const Card& card, const Deck& deck)
{
  RigidElement element{.group = name_of_rigid("rbe2", card),
                       .reference = card.integer(2, "GN"),
                       .nodes = {},
                       .card = &card};
  // Behind the nodes may stand ALPHA, a coefficient of thermal expansion, with a point.
  for (std::size_t i = 4; i <= card.n_fields(); ++i) {
    if (!card.has(i)) continue;
    if (card.field(i).find('.') != std::string_view::npos) {
      card.expect_no_more_than(i);
      break;
    }
    if (card.field(i) == "THRU") card.refuse("RBE2 has no THRU; write the nodes out");
    element.nodes.push_back(card.integer(i, "number of a node"));
  }
  if (element.nodes.empty()) card.refuse("has no nodes that follow");
  const std::vector<int> held = card.components(3);
  if (held.empty()) card.refuse("needs the components that follow, as 123456, in field 4");
  const bool is_of_solids =
      held == std::vector<int>{0, 1, 2} && !have_rotations(deck, element.nodes);
  if (held.size() != 6 && !is_of_solids) element.components = held;
  return element;
}

/// Weights and their components, each with nodes; UM and ALPHA behind have no counterpart.
RigidElement rbe3(const Card& card)
{
  card.expect_blank(2, 2, "this field of RBE3 is blank");
  const std::vector<int> moved = card.components(4);
  RigidElement element{.group = name_of_rigid("rbe3", card),
                       .reference = card.integer(3, "REFGRID"),
                       .nodes = {},
                       .card = &card};
  double weight = 0.0;
  for (std::size_t i = 5; i <= card.n_fields(); ++i) {
    if (!card.has(i)) continue;
    if (card.field(i).find('.') == std::string_view::npos) {
      if (weight == 0.0) card.refuse("needs a weight with a point, as 1., before the nodes");
      element.nodes.push_back(card.integer(i, "number of a node"));
      element.weights[element.nodes.back()] += weight;
      continue;
    }
    weight = card.real(i, "a weight");
    if (card.components(++i) != std::vector<int>{0, 1, 2}) {
      card.refuse(
          "averages other components than 123 of its nodes; a scene's coupling these alone");
    }
  }
  if (element.nodes.empty()) card.refuse("has no nodes to average");
  const bool is_plain =
      std::ranges::all_of(element.weights, [&](const auto& of) { return of.second == weight; });
  const bool is_whole = moved.size() == 6 || moved == std::vector<int>{0, 1, 2};
  if (!is_plain || !is_whole) element.components = moved;
  return element;
}

/// A rigid bar: one end has all independent components, the other all dependent ones.
RigidElement rbar(const Card& card)
{
  const auto holds_all = [&](std::size_t i) { return card.components(i).size() == 6; };
  const std::int64_t a = card.integer(2, "GA"), b = card.integer(3, "GB");
  const bool leads_a =
      holds_all(4) && !card.has(5) && !card.has(6) && (!card.has(7) || holds_all(7));
  const bool leads_b =
      holds_all(5) && !card.has(4) && !card.has(7) && (!card.has(6) || holds_all(6));
  if (!leads_a && !leads_b) {
    card.refuse(
        "is not wholly rigid: a scene's link has the six independent components 123456 at one end, "
        "and all dependent ones at the other");
  }
  return {.group = name_of_rigid("rbar", card),
          .reference = leads_a ? a : b,
          .nodes = {leads_a ? b : a},
          .card = &card};
}

/// A term of an MPC: node, component and factor; two stand in each line.
struct MpcTerm {
  std::int64_t node;
  int component;
  double factor;
};

std::vector<MpcTerm> terms_of(const Card& card)
{
  std::vector<MpcTerm> terms;
  for (std::size_t i = 2; i <= card.n_fields(); i += (i % 8 == 2 ? 3 : 5)) {
    if (!card.has(i)) continue;
    const auto c = card.components(i + 1);
    if (c.size() != 1) card.refuse("needs one component of 1 to 6 for each node");
    terms.push_back({card.integer(i, "number of a node"), c.front(), card.real(i + 2, "a factor")});
  }
  if (terms.empty()) card.refuse("has no terms");
  return terms;
}

/// The equations of a pair of nodes.
struct Link {
  std::vector<const Card*> cards;
  std::set<int> components;
};

/// Equations of two terms, A and -A, by the node that follows and the one that it follows.
using Links = std::map<std::pair<std::int64_t, std::int64_t>, Link>;

void add_link(Links& links, const Card& card)
{
  const std::vector<MpcTerm> terms = terms_of(card);
  if (terms.size() != 2 || terms[0].component != terms[1].component ||
      terms[0].factor != -terms[1].factor || terms[0].factor == 0.0)
    return;
  Link& link = links[{terms[0].node, terms[1].node}];
  link.cards.push_back(&card);
  link.components.insert(terms[0].component);
}

/// The nodes stand at one place.
bool are_together(const Deck& deck, std::int64_t a, std::int64_t b)
{
  const auto first = deck.nodes.find(a), second = deck.nodes.find(b);
  if (first == deck.nodes.end() || second == deck.nodes.end()) return false;
  constexpr double same_place = 1e-6;
  return norm(minus(first->second, second->second)) <= same_place * norm(first->second);
}

/// Those that join all components of two nodes at one place.
Links rigid_links(std::span<const Card> cards, const Deck& deck)
{
  const std::set<std::int64_t> sets = chosen_sets(cards, "MPC").sets;
  Links links;
  for (const Card& card : cards)
    if (card.name() == "MPC" && sets.contains(card.integer(1, "SID"))) add_link(links, card);
  std::erase_if(links, [&](const auto& of) {
    const auto& [nodes, link] = of;
    return link.components.size() != 6 || !are_together(deck, nodes.first, nodes.second) ||
           deck.axes.contains(nodes.first) || deck.axes.contains(nodes.second);
  });
  return links;
}

/// The numbers of the sets of the bulk data, by the cards that define them.
std::set<std::int64_t> defined_sets(std::span<const Card> cards, const std::string& word)
{
  std::set<std::int64_t> sets;
  for (const Card& card : cards)
    if (card.name() == word || (word == "SPC" && card.name() == "SPC1"))
      sets.insert(card.integer(1, "SID"));
  return sets;
}

/// The sets that SPCADD or MPCADD of this number joins, else the set of this number.
std::set<std::int64_t> joined_sets(std::span<const Card> cards, const std::string& word,
                                   std::int64_t number)
{
  for (const Card& card : cards) {
    if (card.name() != word + "ADD" || card.integer(1, "SID") != number) continue;
    std::set<std::int64_t> sets;
    for (const NumberRange& range : card.ranges(2, "number of a set")) {
      if (range.from != range.to) card.refuse("has no THRU; write the sets out");
      sets.insert(range.from);
    }
    return sets;
  }
  return {number};
}

std::string listed(const std::set<std::int64_t>& numbers)
{
  return fmt::format("{}", fmt::join(numbers, ", "));
}

/// Without a choice there must be one set, or an SPCADD of all.
std::set<std::int64_t> only_set(std::span<const Card> cards, const std::string& word,
                                const std::set<std::int64_t>& defined)
{
  if (defined.size() <= 1) return defined;
  for (const Card& card : cards)
    if (card.name() == word + "ADD" && joined_sets(cards, word, card.integer(1, "SID")) == defined)
      return defined;
  std::int64_t first = 0;
  for (const Card& card : cards) {
    if (card.name() != word && !(word == "SPC" && card.name() == "SPC1")) continue;
    const std::int64_t set = card.integer(1, "SID");
    if (first != 0 && set != first) {
      card.refuse(
          fmt::format("belongs to a second set; say {} = ... before BEGIN BULK, or keep only the "
                      "set that the analysis uses",
                      word));
    }
    first = set;
  }
  return defined;
}

}  // namespace

ChosenSets chosen_sets(std::span<const Card> cards, const std::string& word)
{
  const std::set<std::int64_t> defined = defined_sets(cards, word);
  const auto choice = std::ranges::find_if(
      cards, [&](const Card& card) { return card.name() == "CASE" && card.field(1) == word; });
  ChosenSets chosen;
  if (choice == cards.end() || !choice->has(2)) {
    chosen.sets = only_set(cards, word, defined);
    if (choice != cards.end() && !chosen.sets.empty()) {
      chosen.notes.push_back(
          fmt::format("case control chooses no {}; taken is the only set {} of the bulk data: take "
                      "it out of the scene if the body is free of it",
                      word, listed(chosen.sets)));
    }
    return chosen;
  }
  chosen.sets = joined_sets(cards, word, choice->integer(2, "number of a set"));
  for (const std::int64_t set : chosen.sets)
    if (!defined.contains(set)) choice->refuse(fmt::format("there is no {} {}", word, set));
  std::set<std::int64_t> others;
  std::ranges::set_difference(defined, chosen.sets, std::inserter(others, others.end()));
  if (!others.empty()) {
    chosen.notes.push_back(fmt::format("{} of the set {} are left out: case control chooses {}",
                                       word, listed(others), choice->field(2)));
  }
  return chosen;
}

std::vector<int> held_by_grid(const Card& card)
{
  return card.field(7) == "0" ? std::vector<int>{} : card.components(7);
}

std::vector<std::int64_t> listed_nodes(const Card& card, std::size_t first, const Deck& deck)
{
  std::vector<std::int64_t> nodes;
  for (const NumberRange& range : card.ranges(first, "number of a node")) {
    if (range.from == range.to) nodes.push_back(range.from);
    for (auto node = deck.nodes.lower_bound(range.from);
         range.from < range.to && node != deck.nodes.end() && node->first <= range.to; ++node)
      if ((node->first - range.from) % range.step == 0) nodes.push_back(node->first);
  }
  return nodes;
}

std::vector<HeldNodes> held_nodes(const Card& card, const Deck& deck)
{
  const std::int64_t set = card.integer(1, "SID");
  if (card.name() == "SPC1")
    return {{.set = set, .components = card.components(2), .nodes = listed_nodes(card, 3, deck)}};
  card.expect_no_more_than(7);
  std::vector<HeldNodes> held;
  for (const std::size_t first : {std::size_t{2}, std::size_t{5}}) {
    if (!card.has(first)) continue;
    held.push_back({.set = set,
                    .components = card.components(first + 1),
                    .nodes = {card.integer(first, "number of a node")}});
  }
  return held;
}

std::string name_of_held(std::int64_t set, const std::vector<int>& components)
{
  return fmt::format("spc_{}_{}", set, digits(components));
}

std::string name_of_held_by_grid(const std::vector<int>& components)
{
  return "ps_" + digits(components);
}

std::vector<RigidElement> rigid_elements(std::span<const Card> cards, const Deck& deck)
{
  std::vector<RigidElement> elements;
  for (const Card& card : cards) {
    if (card.name() == "RBE2") elements.push_back(rbe2(card, deck));
    if (card.name() == "RBE3") elements.push_back(rbe3(card));
    if (card.name() == "RBAR") elements.push_back(rbar(card));
  }
  for (const auto& [nodes, link] : rigid_links(cards, deck)) {
    elements.push_back(
        {.group = fmt::format("mpc_{}_{}", link.cards.front()->field(1), nodes.first),
         .reference = nodes.second,
         .nodes = {nodes.first},
         .card = link.cards.front()});
  }
  return elements;
}

std::vector<DeckEquation> equations_of_cards(std::span<const Card> cards, const Deck& deck)
{
  const std::set<std::int64_t> sets = chosen_sets(cards, "MPC").sets;
  std::set<const Card*> of_links;
  for (const auto& [nodes, link] : rigid_links(cards, deck))
    of_links.insert(link.cards.begin(), link.cards.end());
  std::vector<DeckEquation> equations;
  for (const Card& card : cards) {
    if (card.name() != "MPC" || !sets.contains(card.integer(1, "SID")) || of_links.contains(&card))
      continue;
    equations.push_back(
        {.entry = fmt::format("{}: MPC {}", card.place(), card.field(1)), .terms = {}});
    for (const auto& [node, component, factor] : terms_of(card)) {
      if (!deck.nodes.contains(node)) card.refuse(fmt::format("there is no GRID {}", node));
      add_term(deck, equations.back(), {node, component, factor});
    }
  }
  return equations;
}

}  // namespace chladni::mesh
