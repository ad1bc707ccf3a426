#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "common/error.hpp"
#include "mesh/decks/nastran.hpp"
#include "mesh/vectors.hpp"

namespace chladni::mesh {
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

RigidElement rbe2(const Card& card)
{
  if (card.components(3).size() != 6)
    card.refuse("holds not all components 123456, as a scene's rigid coupling does");
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
  return element;
}

/// One weight and its components, then nodes; UM and ALPHA behind have no counterpart.
RigidElement rbe3(const Card& card)
{
  card.expect_blank(2, 2, "this field of RBE3 is blank");
  if (card.components(4).size() != 6)
    card.refuse("averages not all components 123456 of its reference node");
  if (card.components(6) != std::vector<int>{0, 1, 2})
    card.refuse("averages other components than 123 of its nodes; a scene's coupling these alone");
  RigidElement element{.group = name_of_rigid("rbe3", card),
                       .reference = card.integer(3, "REFGRID"),
                       .nodes = {},
                       .card = &card};
  card.real(5, "a weight");
  for (std::size_t i = 7; i <= card.n_fields(); ++i) {
    if (!card.has(i)) continue;
    if (card.field(i).find('.') != std::string_view::npos)
      card.refuse("has several weights; a scene weighs nodes by the area that each stands for");
    element.nodes.push_back(card.integer(i, "number of a node"));
  }
  if (element.nodes.empty()) card.refuse("has no nodes to average");
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

/// The equations of a pair of nodes.
struct Link {
  const Card* card;
  std::set<int> components;
};

/// Equations of two terms by the node that follows and the one that it follows.
using Links = std::map<std::pair<std::int64_t, std::int64_t>, Link>;

void add_equation(Links& links, const Card& card)
{
  card.expect_blank(8, std::max<std::size_t>(8, card.n_fields()),
                    "has more than two terms; a scene has no equations but rigid links");
  const auto c = card.components(3);
  if (c.size() != 1 || card.components(6) != c)
    card.refuse("joins two components; a scene's rigid link joins each one with itself");
  if (card.real(4, "A1") != -card.real(7, "A2") || card.real(4, "A1") == 0.0)
    card.refuse("its coefficients are not A and -A, as in a rigid link");
  const std::pair nodes{card.integer(2, "G1"), card.integer(5, "G2")};
  links.try_emplace(nodes, Link{.card = &card, .components = {}})
      .first->second.components.insert(c.front());
}

/// The nodes stand at one place.
bool are_together(const Deck& deck, std::int64_t a, std::int64_t b)
{
  const auto first = deck.nodes.find(a), second = deck.nodes.find(b);
  if (first == deck.nodes.end() || second == deck.nodes.end()) return false;
  constexpr double same_place = 1e-6;
  return norm(minus(first->second, second->second)) <= same_place * norm(first->second);
}

std::vector<RigidElement> links_of_equations(std::span<const Card> cards, const Deck& deck)
{
  const std::set<std::int64_t> sets = chosen_sets(cards, "MPC").sets;
  Links links;
  for (const Card& card : cards)
    if (card.name() == "MPC" && sets.contains(card.integer(1, "SID"))) add_equation(links, card);
  std::vector<RigidElement> elements;
  for (const auto& [nodes, link] : links) {
    if (link.components.size() != 6) {
      link.card->refuse(fmt::format(
          "joins {} of 6 components of the nodes {} and {}; a scene's rigid link joins all of them",
          link.components.size(), nodes.first, nodes.second));
    }
    if (!are_together(deck, nodes.first, nodes.second)) {
      link.card->refuse(fmt::format(
          "its nodes {} and {} are apart, where equal displacements and rotations are no rigid "
          "link; take RBE2 or RBAR",
          nodes.first, nodes.second));
    }
    elements.push_back({.group = fmt::format("mpc_{}_{}", link.card->field(1), nodes.first),
                        .reference = nodes.second,
                        .nodes = {nodes.first},
                        .card = link.card});
  }
  return elements;
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
    if (card.real_or(first + 2, "a displacement", 0.0) != 0.0)
      card.refuse("prescribes a displacement; a scene's support holds at zero only");
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
    if (card.name() == "RBE2") elements.push_back(rbe2(card));
    if (card.name() == "RBE3") elements.push_back(rbe3(card));
    if (card.name() == "RBAR") elements.push_back(rbar(card));
  }
  std::ranges::move(links_of_equations(cards, deck), std::back_inserter(elements));
  return elements;
}

}  // namespace chladni::mesh
