#include <fmt/format.h>

#include <algorithm>

#include "mesh/decks/nastran.hpp"

namespace chladni::mesh {
namespace {

std::string digits(const std::vector<int>& components)
{
  std::string text;
  for (const int c : components) text += static_cast<char>('1' + c);
  return text;
}

RigidElement rbe2(const Card& card)
{
  if (card.components(3).size() != 6)
    card.refuse("holds not all components 123456; a scene's rigid coupling does");
  RigidElement element{.reference = card.integer(2, "GN"), .nodes = {}};
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
  RigidElement element{.reference = card.integer(3, "REFGRID"), .nodes = {}};
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

}  // namespace

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

RigidElement rigid_element(const Card& card)
{
  return card.name() == "RBE2" ? rbe2(card) : rbe3(card);
}

}  // namespace chladni::mesh
