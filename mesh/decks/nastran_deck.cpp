#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <unordered_map>

#include "common/error.hpp"
#include "mesh/decks/holders.hpp"
#include "mesh/decks/nastran.hpp"

namespace chladni::mesh {
namespace {

constexpr const char* no_offset =
    "the element stands off its nodes; a scene has one `offset` for each section";
constexpr const char* no_own_thickness =
    "a thickness of its own; a scene has it in the section, as a table or a formula";

/// Of what becomes of the deck, by card.
class Reader {
 public:
  explicit Reader(std::span<const Card> cards) : cards_(cards), systems_(nastran_systems(cards)) {}

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
    couple();
    add_missing_middles(deck_);
    for (const auto& [name, n] : left_out_)
      deck_.notes.push_back(fmt::format("{} {} are left out: they are no part of a mesh", n, name));
    return std::move(deck_);
  }

 private:
  using ReadCard = std::function<void(Reader&, const Card&)>;
  using Readers = std::unordered_map<std::string, ReadCard>;

  /// Every card that is known. Sections and materials are `nastran_declarations`'.
  static const Readers& readers()
  {
    static const Readers all = make_readers();
    return all;
  }

  static Readers make_readers()
  {
    Readers all{{"SET1", &Reader::set1},    {"SPC", &Reader::held},
                {"SPC1", &Reader::held},    {"PARAM", &Reader::parameter},
                {"CONM2", &Reader::mass},   {"CELAS1", &Reader::spring},
                {"CELAS2", &Reader::spring}};
    for (const char* name : {"RBE2", "RBE3", "RBAR"}) all.emplace(name, &Reader::rigid);
    for (const char* name : {"CQUAD4", "CTRIA3"}) all.emplace(name, &Reader::flat_shell);
    for (const char* name : {"CQUAD8", "CTRIA6"}) all.emplace(name, &Reader::curved_shell);
    for (const char* name : {"CBAR", "CBEAM"}) all.emplace(name, &Reader::beam);
    for (const char* name : {"CORD2R", "CORD2C", "CORD2S", "MAT1", "PSHELL", "PBAR", "PBARL",
                             "PBEAM", "PELAS", "CASE", "GRDSET", "SPCADD", "MPC", "MPCADD"})
      all.emplace(name, [](Reader&, const Card&) {});
    for (const char* name : {"EIGR", "EIGRL", "FORCE", "MOMENT", "PLOAD", "PLOAD2", "PLOAD4",
                             "GRAV", "LOAD", "TEMP", "TEMPD"})
      all.emplace(name, [](Reader& reader, const Card& card) { ++reader.left_out_[card.name()]; });
    return all;
  }

  [[noreturn]] static void refuse_unknown(const Card& card)
  {
    for (const char* solid : {"CTETRA", "CHEXA", "CPENTA", "CPYRAM", "CHEXA8", "CHEXA20"}) {
      if (card.name() != solid) continue;
      card.refuse(
          "a solid element; Chladni has shells and beams: mesh the mid-surface with CQUAD4, "
          "CQUAD8, "
          "CTRIA3 or CTRIA6, or reduce the solids in the program that they come from");
    }
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
    const std::vector<int> held = held_by_grid(card);
    if (!held.empty()) add_to(name_of_held_by_grid(held), {number});
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
                                                                : "shell or beam";
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

  void add_surface(const Card& card, const std::vector<std::int64_t>& of_card)
  {
    deck_.elements.push_back(
        surface_element(element_number(card), of_card, property_group(card, "pshell", 2)));
    deck_.elements.back().place = card.place();
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
    const char* kind = card.name() == "CBAR" ? "pbar" : "pbeam";
    deck_.elements.push_back({.number = element_number(card),
                              .shape = Shape::line,
                              .order = 1,
                              .nodes = nodes(card, 2),
                              .group = property_group(card, kind, 1),
                              .place = card.place()});
  }

  void rigid(const Card& card) { element_number(card); }

  void couple()
  {
    for (const RigidElement& element : rigid_elements(cards_, deck_)) {
      add_to(element.group, element.nodes);
      deck_.couplings.push_back({.entry = fmt::format("{}: {} {}", element.card->place(),
                                                      element.card->name(), element.card->field(1)),
                                 .reference = element.reference,
                                 .group = element.group,
                                 .averages = element.averages()});
    }
    add_leaders(deck_);
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
    for (const HeldNodes& of_card : held_nodes(card, deck_))
      add_to(name_of_held(of_card.set, of_card.components), of_card.nodes);
  }

  void set1(const Card& card)
  {
    add_to(fmt::format("set_{}", card.integer(1, "SID")), listed_nodes(card, 2, deck_));
  }

  void parameter(const Card& card)
  {
    if (card.field(1) == "WTMASS" && card.real(2, "WTMASS") != 1.0) {
      card.refuse(
          "densities stand in another unit than forces and lengths; scale them in the deck, and "
          "take this card out");
    }
    ++left_out_[card.name()];
  }

  std::span<const Card> cards_;
  DeckSystems systems_;
  Deck deck_;
  std::set<std::pair<std::string, std::int64_t>> element_numbers_;
  std::map<std::string, int> left_out_;
};

}  // namespace

Deck nastran_deck(std::span<const Card> cards)
{
  return Reader(cards).read();
}

}  // namespace chladni::mesh
